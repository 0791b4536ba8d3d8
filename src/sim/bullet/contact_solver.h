// ContactSolver: projected Gauss-Seidel sweeps (iterations, not motions) over the contacts and friction of an island,
// in a compact row format.
#pragma once

#include "sim/bullet/bullet.h"
#include "sim/bullet/joints/joint_block.h"

namespace limber::sim::bullet {

/// Bullet sets up the rows; the sweeps copy the values they need, 96 bytes per row instead of 160, with the rows of one
/// pair of bodies in sequence, so that the pair's velocities are read and written once for all of them. The order is
/// Bullet's. Normal rows round like Bullet's: impulses are identical to the bit if bodies may move and turn along every
/// axis or not at all. The two friction rows of a contact are solved together, within the disc that the friction cone
/// has at the normal's impulse; Bullet's square allows up to 1.41 times as much, depending on the direction. Allocates
/// only if an island is larger than all before. [sim]
class ContactSolver {
 public:
  /// Copies an island's rows: contacts, and in their order two friction rows for each. All three must remain valid
  /// until finish().
  void begin(btAlignedObjectArray<btSolverBody>& bodies, const btConstraintArray& contacts,
             const btConstraintArray& friction);

  /// One sweep of the split impulse, which corrects penetration without changing velocities. Returns the largest
  /// squared change of an impulse.
  btScalar sweep_split_impulse();
  /// One sweep over all contacts, then over the friction of those that press. Returns the largest squared change of an
  /// impulse.
  btScalar sweep();

  /// Present impulse of contact `i`, N·s.
  btScalar impulse(int i) const { return contacts_[i].impulse; }

  /// Writes the impulses to Bullet's rows.
  void finish() const;

 private:
  // The fourth elements of the first three vectors ([3]) are not part of any sum and hold scalars.
  struct Row {
    Float4 normal;      // for body a; body b's is the negative. [3]: impulse if the bodies didn't move
    Float4 jacobian_a;  // angular Jacobian. [3]: impulse per rate
    Float4 jacobian_b;  // [3]: softness, relative to the impulse
    Float4 response_a;  // angular velocity change of the bodies per impulse
    Float4 response_b;
    float impulse;
    float friction;
    float push_target;  // normal rows: 0 if it doesn't penetrate. Friction rows: the smaller step of the contact's two
                        // rows, relative to this one's
    float push_impulse;
  };
  struct Pair {  // contacts from first to end; friction rows have twice these indices
    int a, b;
    int first, end;
  };

  static void load_row(const btSolverConstraint& from, bool a_moves, Row& row);
  [[gnu::always_inline]] static float solve(Row& row, float target, float& impulse, float lower, float upper,
                                            PairVelocity& v);
  [[gnu::always_inline]] static float unclamped_change(const Row& row, const PairVelocity& v);
  [[gnu::always_inline]] static float solve_friction(Row& first, Row& second, float normal_impulse, PairVelocity& v);
  template <class Velocity, class Work>
  void for_each_contact(Work&& work);

  btAlignedObjectArray<btSolverBody>* bodies_ = nullptr;
  const btConstraintArray* bullet_contacts_ = nullptr;
  const btConstraintArray* bullet_friction_ = nullptr;
  btAlignedObjectArray<Row> contacts_;
  btAlignedObjectArray<Row> friction_;
  btAlignedObjectArray<Pair> pairs_;
};

}  // namespace limber::sim::bullet
