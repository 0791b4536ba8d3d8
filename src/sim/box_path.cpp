// The path to the solution: a problem that the present impulses solve is led over into the one that is asked, and its
// solution followed from one change of a row's status to the next. Lemke's method, on rows with bounds.
#include <algorithm>
#include <cmath>

#include "sim/box_solver.h"

namespace limber {
namespace {

/// Exchanges in which the end of the path is made exact.
constexpr int kPolishes = 8;
/// Slower than this part of the fastest, nothing moves.
constexpr double kStill = 1e-12;

}  // namespace

// Adds to what is left so that every law holds at the present impulses; rows that want to leave their bounds will do so
// one after another, as it is taken away.
void BoxSolver::cover() {
  cover_.assign(nth(stride_), 0);
  double most = 0;
  const auto side = [this](int i) { return status_[nth(i)] == free ? 0 : status_[nth(i)] == at_upper ? 1 : -1; };
  for (int i = 0; i < size(); ++i) {
    if (response(i, i) > 0 && row(i).lower < row(i).upper) most = std::max(most, -side(i) * left_[nth(i)]);
  }
  for (int i = 0; i < size(); ++i) {
    if (!(response(i, i) > 0)) continue;
    const double left = left_[nth(i)];
    if (status_[nth(i)] == free) {
      cover_[nth(i)] = -left;
    } else if (row(i).lower < row(i).upper) {
      const double spread = 0.1 + std::fmod(0.6180339887498949 * (i + 1), 1.0);
      cover_[nth(i)] = side(i) * (std::max(-side(i) * left, 0.0) + most * spread);
    }
  }
  uncover(-1);
}

void BoxSolver::uncover(double part) {
  for (std::size_t i = 0; i < cover_.size(); ++i) left_[i] -= part * cover_[i];
}

// How impulses and what is left change per part of the cover, while no status does. False: that can't be told.
bool BoxSolver::lead() {
  assemble();
  if (static_cast<int>(free_.size()) > kMostFree || !decompose()) return false;
  step_.resize(free_.size());
  for (std::size_t i = 0; i < free_.size(); ++i) step_[i] = cover_[nth(free_[i])];
  solve_step();
  along_.assign(nth(stride_), 0);
  for (std::size_t i = 0; i < free_.size(); ++i) along_[nth(free_[i])] = step_[i];
  for (int i = 0; i < size(); ++i) {
    if (slides_with(i) >= 0) along_[nth(i)] = (status_[nth(i)] == at_upper ? 1 : -1) * room_along(i, free);
  }
  left_along_ = cover_;
  effort_.lines(size(), static_cast<double>(free_.size()));
  for (int i = 0; i < size(); ++i) {
    if (along_[nth(i)] != 0) respond(left_along_, i, along_[nth(i)]);
  }
  return true;
}

// How the room of a row towards one of its bounds changes, or (free) the width of its bounds.
double BoxSolver::room_along(int i, Status side) const {
  const Row& r = rows_[nth(i)];
  const double wider = r.normal >= 0 && status_[nth(r.normal)] == free ? r.friction * along_[nth(r.normal)] : 0;
  return side == free ? wider : (side == at_upper ? wider - along_[nth(i)] : wider + along_[nth(i)]);
}

void BoxSolver::meet(Change& next, int i, double room, double rate, Status to) const {
  if (!(rate < 0)) return;
  const double way = std::max(room, 0.0) / -rate;
  if (way < next.way) next = {i, way, to};
}

// The first one within `most`, going where the cover becomes more (sign 1) or less (-1).
BoxSolver::Change BoxSolver::next_change(double sign, double most) {
  Change next{-1, most, free};
  double fast = 0;
  double left_fast = 0;
  for (int i = 0; i < size(); ++i) {
    fast = std::max(fast, std::fabs(along_[nth(i)]));
    left_fast = std::max(left_fast, std::fabs(left_along_[nth(i)]));
  }
  for (int i = 0; i < size(); ++i) {
    Row& r = row(i);
    if (!(response(i, i) > 0)) continue;
    bound(r);
    if (status_[nth(i)] == free) {
      for (const Status side : {at_lower, at_upper}) {
        const double room = side == at_upper ? r.upper - r.impulse : r.impulse - r.lower;
        const double rate = sign * room_along(i, side);
        if (rate < -kStill * fast) meet(next, i, room, rate, side);
      }
    } else if (r.normal >= 0 || r.lower < r.upper) {
      const double side = status_[nth(i)] == at_upper ? 1 : -1;
      const double rate = side * sign * left_along_[nth(i)];
      if (rate < -kStill * left_fast) meet(next, i, side * left_[nth(i)], rate, free);
    }
  }
  return next;
}

void BoxSolver::walk(double way) {
  for (int i = 0; i < size(); ++i) {
    row(i).impulse += way * along_[nth(i)];
    left_[nth(i)] += way * left_along_[nth(i)];
  }
}

// False where nothing else follows from it: friction without a normal's impulse, which may be at either of its bounds.
bool BoxSolver::take_change(const Change& change) {
  const int i = change.row;
  Row& r = row(i);
  if (change.to == free && r.normal >= 0 && status_[nth(r.normal)] != free) {
    status_[nth(i)] = status_[nth(i)] == at_upper ? at_lower : at_upper;
    return false;
  }
  status_[nth(i)] = change.to;
  if (change.to == free) return true;
  bound(r);
  put(i, change.to == at_upper ? r.upper : r.lower);
  for (int k = 0; k < size(); ++k) {
    if (row(k).normal != i) continue;
    put(k, 0);
    if (status_[nth(k)] == free) status_[nth(k)] = at_upper;
  }
  return true;
}

bool BoxSolver::follow_path(int changes) {
  if (std::any_of(rows_.begin(), rows_.end(), [](const Row& r) { return r.most > 0; })) return false;
  for (int i = 0; i < size(); ++i) {
    bound(row(i));
    put(i, std::clamp(row(i).impulse, row(i).lower, row(i).upper));
  }
  read_statuses();
  cover();
  double covered = 1;
  double sign = -1;
  int entered = -1;
  Status was = free;
  for (; changes > 0 && !effort_.over() && lead(); --changes) {
    if (entered >= 0) {
      const Status now = status_[nth(entered)];
      const double opens = now == free ? room_along(entered, was)
                                       : (now == at_upper ? left_along_[nth(entered)] : -left_along_[nth(entered)]);
      sign = opens > 0 ? 1 : -1;
    }
    const Change next = next_change(sign, sign < 0 ? covered : 1e6);
    if (next.row < 0 && sign > 0) break;
    walk(sign * next.way);
    covered += sign * next.way;
    if (next.row < 0) return pivot(kPolishes);
    was = status_[nth(next.row)];
    entered = take_change(next) ? next.row : -1;
  }
  uncover(covered);
  return false;
}

}  // namespace limber
