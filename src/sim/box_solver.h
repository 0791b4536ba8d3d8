// BoxSolver: impulses within bounds, friction's bounds following its normal, for a dense response matrix. Block
// pivoting with friction that slides tied to its normal; projected Gauss-Seidel where that needs help. No Bullet.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "sim/dense.h"
#include "sim/effort.h"
#include "sim/free_factor.h"

namespace limber {

/// left = wanted rate - response·impulses, one each row; a row obeys when left is 0 within its bounds, <= 0 at the
/// lower and >= 0 at the upper one. [sim]
class BoxSolver {
 public:
  enum Status : unsigned char { free, at_lower, at_upper, unknown };
  struct Row {
    double left = 0;  ///< What is missing at the present impulse.
    double impulse = 0;
    double lower = 0;
    double upper = 0;
    int normal = -1;         ///< Friction: the row before this one whose impulse it follows.
    double friction = 0;     ///< Its bounds are plus and minus this part of the normal's impulse,
    double most = 0;         ///< or this, where it is less (0: no such bound).
    Status guess = unknown;  ///< Where it may stand in the end; unknown: as its impulse says.
    double ahead = 0;        ///< The search begins with so much more than its impulse.
  };

  explicit BoxSolver(Effort& effort);
  /// Rows and a response of zeros.
  void start(int rows);
  /// As many rows as `from` has, each where that says that it was (-1: new); responses between rows that were are kept,
  /// others are 0.
  void grow(std::span<const int> from);
  /// Adds the square of each line to the responses; lines have a number for each row at least, `width` (even) in all.
  void add_squares(std::span<const double> lines, int width);
  int size() const { return static_cast<int>(rows_.size()); }
  Row& row(int i) { return rows_[static_cast<std::size_t>(i)]; }
  /// Response of row i to a unit impulse of row j; symmetric, to be set for both orders. Softness stands on the
  /// diagonal.
  double& response(int i, int j) {
    return response_[static_cast<std::size_t>(i) * static_cast<std::size_t>(stride_) + static_cast<std::size_t>(j)];
  }

  /// Until no row misses its law by more than `tolerance` (in units of rate), or what the effort allows by now. Returns
  /// by how much one still does.
  /// Where friction and its normals agree on nothing (they need not), or there is no time left to agree, friction's
  /// bounds are those of the normals one round before; all other laws hold.
  double solve(double tolerance);
  /// Whether friction's bounds are those of the normals that were found.
  bool agrees() const { return !frozen_; }
  /// Where they are not: brings them nearer to each other, from where the rows stand. Returns what a row still misses.
  double polish();
  /// Where a row stood in what was found last.
  Status status(int i) const { return status_[static_cast<std::size_t>(i)]; }

 private:
  /// More rows than this are not solved at once: it costs their cube.
  static constexpr int kMostFree = 90;
  /// Up to so many nothing has to be allocated.
  static constexpr std::size_t kUsualRows = 160;
  static std::size_t nth(int i) { return static_cast<std::size_t>(i); }
  void bound(Row& row) const;
  double tolerance() const { return effort_.tolerance(asked_); }
  void begin();
  void end();
  void search();
  void search_briefly();
  void sweep_last();
  void start_ahead();
  void restart();
  void recenter();
  void apply(int i, double change);
  void put(int i, double impulse) { apply(i, impulse - row(i).impulse); }
  void change(int i, double by);
  void change_to(int i, double impulse) { change(i, impulse - row(i).impulse); }
  void respond();
  void sweep();
  void sweep(int most);
  double missed();
  double take_missed();
  void read_statuses();
  bool pivot(int exchanges);
  int exchange(bool only_last);
  void follow_normals();
  bool solve_free();
  void assemble();
  int slides_with(int i) const;
  bool decompose();
  void solve_step();
  void correct_free();
  bool descend();
  bool choose_free();
  void step_free();
  bool step_within_bounds();
  int release(bool only_one);
  struct Change {  // of a row's status, on the path
    int row = -1;
    double way = 0;
    Status to = free;
  };
  bool follow_path(int changes);
  void cover();
  void uncover(double part);
  bool lead();
  double room_along(int i, Status side) const;
  Change next_change(double sign, double most);
  void meet(Change& next, int i, double room, double rate, Status to) const;
  void walk(double way);
  bool take_change(const Change& change);
  void respond(std::vector<double>& to, int i, double change) const;
  void hold_friction(double part);
  bool settle_friction();
  void agree_at_last();

  Effort& effort_;
  double asked_ = 0;  // tolerance of a cheap step
  int stride_ = 0;
  std::vector<Row> rows_;
  std::vector<double> left_;
  std::vector<double> response_;
  std::vector<double> old_response_;
  std::vector<double> eases_;  // one through a row's own response
  std::vector<ScaledLine> changed_;
  std::vector<double> start_;   // impulses
  std::vector<double> center_;  // impulses that softness pulls to
  std::vector<Status> status_;
  std::vector<Status> settled_status_;
  std::vector<double> settled_;
  std::vector<double> held_;  // bounds of friction
  FreeFactor steady_;         // of the free rows, while friction's bounds stay
  std::vector<unsigned char> marks_;
  std::vector<double> before_;
  std::vector<double> left_before_;
  std::vector<int> free_;
  std::vector<int> place_;  // row: in free_, or -1
  std::vector<int> ties_;   // row: place of the normal that it slides with, or -1
  std::vector<double> factor_;
  std::vector<int> exchanged_;  // line of the factor that came in each one's place
  std::vector<double> step_;
  std::vector<double> cover_;  // added to what is left, times what of the path is left to go
  std::vector<double> along_;  // of impulses and of what is left, per way along the path
  std::vector<double> left_along_;
  double least_missed_ = 0;
  int width_ = 0;          // of a line of the factor
  bool frozen_ = false;    // friction's bounds stay
  bool factored_ = false;  // for the present statuses
};

}  // namespace limber
