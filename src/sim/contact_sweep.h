// ContactSweep: sweeps over the contacts of an island, and over their friction, from rows of our own.
#pragma once

#include "sim/bullet.h"
#include "sim/joint_block.h"

namespace limber {

/// Bullet sets up the rows; the sweeps take from them what they need, in 96 bytes a row instead of 160, with the rows
/// of one pair of bodies behind each other, so that the pair's velocities are read and written once for all of them.
/// The order is Bullet's. Rows along the normals round as Bullet's do: their impulses come out to the bit, where bodies
/// may move and turn along every axis or not at all. The two friction rows of a contact are solved together, within the
/// disc that the cone of friction has at the normal's impulse; Bullet's square holds up to 1.41 times as much,
/// depending on the heading. Nothing is allocated once the largest island was seen. [sim]
class ContactSweep {
 public:
  /// Takes over an island's rows: contacts, each with a friction row in two directions, in the order of the contacts.
  /// All three must stay until finish().
  void begin(btAlignedObjectArray<btSolverBody>& bodies, const btConstraintArray& contacts,
             const btConstraintArray& friction);

  /// One sweep over what penetrates, which moves bodies without giving them speed, or one over all contacts and then
  /// over the friction of those that press. Both return the largest squared change of an impulse.
  btScalar push_apart();
  btScalar sweep();

  /// What contact `i` presses with by now, N·s.
  btScalar impulse(int i) const { return contacts_[i].impulse; }

  /// Writes the impulses into Bullet's rows.
  void finish() const;

 private:
  // The fourth lanes of the first three, which no sum takes in, have room for numbers.
  struct Row {
    Lanes normal;    // of body a; body b's is its negative. [3]: the impulse that would do if nothing moved
    Lanes turn_a;    // what the bodies' turning adds to the row's speed. [3]: impulse for a unit of it
    Lanes turn_b;    // [3]: softness, as part of the impulse
    Lanes answer_a;  // how an impulse turns them
    Lanes answer_b;
    float impulse;
    float friction;
    float push_wanted;  // 0: does not penetrate. Of friction: the smaller step of a contact's two rows, as part of this
    float push;
  };
  struct Pair {  // contacts first up to end, whose friction is at twice that
    int a, b;
    int first, end;
  };

  static void take(const btSolverConstraint& from, bool a_moves, Row& row);
  [[gnu::always_inline]] static float solve(Row& row, float wanted, float& impulse, float lower, float upper,
                                            PairVelocity& v);
  [[gnu::always_inline]] static float free_impulse(const Row& row, const PairVelocity& v);
  [[gnu::always_inline]] static float solve_friction(Row& first, Row& second, float pressing, PairVelocity& v);
  template <class Velocity, class Work>
  void each_pair(Work&& work);

  btAlignedObjectArray<btSolverBody>* bodies_ = nullptr;
  const btConstraintArray* bullet_contacts_ = nullptr;
  const btConstraintArray* bullet_friction_ = nullptr;
  btAlignedObjectArray<Row> contacts_;
  btAlignedObjectArray<Row> friction_;
  btAlignedObjectArray<Pair> pairs_;
};

}  // namespace limber
