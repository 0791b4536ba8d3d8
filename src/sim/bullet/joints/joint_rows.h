// JointRows: the constraint rows that a joint plans for one substep.
#pragma once

#include <cstdint>

#include "sim/bullet/bullet.h"
#include "sim/solver/indexed_array.h"

namespace limber::sim::bullet {

/// Internal step that rows are planned for.
struct StepTiming {
  btScalar h = btScalar(1.0 / 240.0);  ///< Length, s.
  int left = 1;                        ///< Number of steps to the end of the tick, this one included.
  int count = 1;                       ///< Number of steps in the tick.
};

/// A planned constraint row: rate + softness·impulse = velocity, with the impulse in [lower, upper].
struct JointRow {
  enum class Kind : std::uint8_t {
    other,
    motor,   ///< Its impulse counts as applied force.
    repair,  ///< Returns an axis to a limit that it exceeds.
    lock
  };
  static constexpr btScalar kUnbounded = SIMD_INFINITY;  ///< For lower and upper.

  btScalar velocity;
  btScalar softness;
  btScalar lower;
  btScalar upper;
  std::uint8_t axis;
  Kind kind;
};

/// Rows in memory that belongs to the solver. Soft rows come first, hard ones last, because a Gauss-Seidel sweep
/// satisfies its last row exactly: rows of unlocked axes, motors, locks. [sim]
class JointRows {
 public:
  /// Maximum number of rows: for each of six axes a motor or spring (two rows), damping, armature, friction and
  /// two limits.
  static constexpr int kMax = 6 * 7;

  JointRows() = default;
  /// No rows yet. `memory`: space for kMax rows, which must stay valid as long as the rows are used.
  explicit JointRows(JointRow* memory) : rows_(memory) {}
  void add(int axis, btScalar velocity, btScalar softness, btScalar lower, btScalar upper,
           JointRow::Kind kind = JointRow::Kind::other) {
    rows_[count_++] = {velocity, softness, lower, upper, static_cast<std::uint8_t>(axis), kind};
  }
  /// Call between the rows of motors and those of locks. `motors`: there is a row of a motor.
  void begin_locks(bool motors) {
    first_lock_ = count_;
    bounded_ = motors;
  }

  int size() const { return count_; }
  const JointRow& operator[](int i) const { return rows_[i]; }
  const JointRow* begin() const { return rows_; }
  const JointRow* end() const { return rows_ + count_; }
  /// IslandSolver solves the rows of locked axes as a block, together with the motor row before them if has_bounded().
  int first_of_block() const { return first_lock_ - (bounded_ ? 1 : 0); }
  int locked() const { return count_ - first_lock_; }
  bool has_bounded() const { return bounded_; }

 private:
  JointRow* rows_ = nullptr;
  int count_ = 0;
  int first_lock_ = 0;
  bool bounded_ = false;
};

}  // namespace limber::sim::bullet
