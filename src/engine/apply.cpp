// Bringing a difference into a world: shapes, bodies, values, places, order.
#include "engine/apply.h"

#include <algorithm>
#include <bit>
#include <string>

#include "base/check.h"
#include "engine/apply_behaviors.h"

namespace limber {

namespace {

template <class T>
T* living(const World& world, NodeId id) {
  const Store& store = world.store();
  if (!store.alive(id) || &store.table(id) != &T::table()) return nullptr;
  return static_cast<T*>(store.thing(id));
}

std::uint64_t bit_of(std::string_view row) { return std::uint64_t{1} << Part::table().at(row).index; }

// values of a body's things before it is made anew, by kind and name
class Keepsakes {
 public:
  explicit Keepsakes(const Body& body) {
    keep(body, body.id(), "");
    for (const auto& part : body.parts()) keep(body, part->id(), part->name());
    for (const auto& joint : body.joints()) keep(body, joint->id(), joint->name());
    for (const auto& motor : body.motors()) keep(body, motor->id(), motor->name());
    for (const PartPair& pair : body.pairs().list) {
      pairs_.push_back({body.parts()[pair.a]->name(), body.parts()[pair.b]->name(), pair.edit});
    }
  }

  // edits of pairs whose parts are still there
  void give_pairs_to(Body& body) const {
    for (const KeptPair& pair : pairs_) {
      const Part* const a = body.find_part(pair.a);
      const Part* const b = body.find_part(pair.b);
      if (a != nullptr && b != nullptr) (void)body.edit_pair(*a, *b, pair.edit);
    }
  }

  // rows of `leave` and velocities, which go with the posture, are left alone
  void give_to(Store& store, NodeId id, std::string_view name, std::uint64_t leave) const {
    const Table& table = store.table(id);
    const auto found =
        std::find_if(all_.begin(), all_.end(), [&](const Keepsake& k) { return k.table == &table && k.name == name; });
    if (found == all_.end()) return;
    if (&table == &Part::table()) leave |= bit_of("linear_velocity") | bit_of("angular_velocity");
    const std::uint64_t rows = described_rows(table) & ~leave;
    for (const Row& row : table.rows()) {
      if ((rows >> row.index & 1u) == 0) continue;
      const double* const was = (row.live ? found->live : found->kept).data() + row.offset;
      if (std::equal(was, was + row.width, std::as_const(store).values(id, row))) continue;
      (void)store.set(id, row, {was, row.width});  // a mass that can't be set any more stays as it was made
    }
  }

 private:
  struct KeptPair {
    std::string a, b;
    PairEdit edit;
  };
  struct Keepsake {
    const Table* table;
    std::string name;
    std::vector<double> kept, live;
  };
  void keep(const Body& body, NodeId id, const std::string& name) {
    const Store& store = body.store();
    const Table& table = store.table(id);
    const double* const kept = store.kept_block(id);
    const double* const live = store.live_block(id);
    all_.push_back({&table, name, {kept, kept + table.kept_width()}, {live, live + table.live_width()}});
  }

  std::vector<Keepsake> all_;
  std::vector<KeptPair> pairs_;
};

class Applying {
 public:
  explicit Applying(const Application& a) : a_(a), store_(a.world.store()) {}

  void run(LiveThings& things) {
    set_rows(a_.draft.id(), a_.world.id(), a_.difference.world);
    const Visuals& drawn = a_.draft.visuals();
    set_rows(drawn.id(), a_.world.visuals().id(), a_.difference.visuals);
    set_rows(drawn.camera().id(), a_.world.visuals().camera().id(), a_.difference.camera);
    set_rows(drawn.look().id(), a_.world.visuals().look().id(), a_.difference.look);
    remove_bodies(things);
    shapes(things);
    bodies(things);
    gears();
    apply_behaviors(a_, bodies_, kept_behaviors_);
    for (const std::size_t gone : a_.difference.gone_shapes) {
      if (Shape* const shape = living<Shape>(a_.world, things.shapes[gone])) a_.world.remove_shape(*shape);
    }
    a_.world.order_shapes(shapes_);
    a_.world.order_bodies(bodies_);
    things = {};
    for (const Shape* shape : shapes_) things.shapes.push_back(shape->id());
    for (const Body* body : bodies_) things.bodies.push_back(body->id());
  }

 private:
  void set_rows(NodeId from, NodeId to, std::uint64_t rows) {
    const Store& theirs = a_.draft.store();
    for (; rows != 0; rows &= rows - 1) {
      const Row& row = store_.table(to).row(static_cast<std::uint32_t>(std::countr_zero(rows)));
      const double* const values = theirs.values(from, row);
      a_.on_set(to, row);
      if (std::equal(values, values + row.width, std::as_const(store_).values(to, row))) continue;
      const Result<SetOutcome> set = store_.set(to, row, {values, row.width});
      LIMBER_CHECK(set.ok());
    }
  }

  void remove_bodies(const LiveThings& things) {
    for (const std::size_t gone : a_.difference.gone_bodies) {
      if (Body* const body = living<Body>(a_.world, things.bodies[gone])) a_.world.remove_body(*body);
    }
  }

  void shapes(const LiveThings& things) {
    auto next = a_.difference.shapes.begin();
    for (std::size_t i = 0; i < a_.now.shapes.size(); i++) {
      const std::optional<std::size_t> before = a_.difference.shapes_before[i];
      const Shape& described = *a_.draft.shapes()[i];
      Shape* shape = before ? living<Shape>(a_.world, things.shapes[*before]) : nullptr;
      const bool differs = next != a_.difference.shapes.end() && next->now == i;
      if (shape == nullptr) {
        shape = a_.world.find_shape(described.name());
        const bool fresh = shape == nullptr;
        if (fresh) shape = *a_.world.add_shape(described.name(), described.model());
        shape->become(described);
        // the colours that a robot's file gives a new one are not said
        set_rows(described.id(), shape->id(),
                 fresh ? described_rows(Shape::table()) : said_rows(a_.now.shapes[i]->rows));
      } else if (differs) {
        if (next->geometry) shape->become(described);
        set_rows(described.id(), shape->id(), next->rows);
      }
      if (differs) ++next;
      shapes_.push_back(shape);
    }
  }

  void bodies(const LiveThings& things) {
    auto next = a_.difference.bodies.begin();
    for (std::size_t i = 0; i < a_.now.bodies.size(); i++) {
      const std::optional<std::size_t> before = a_.difference.bodies_before[i];
      const bool differs = next != a_.difference.bodies.end() && next->now == i;
      Body* body = before ? living<Body>(a_.world, things.bodies[*before]) : nullptr;
      if (body == nullptr) {
        body = newcomer(i);
      } else if (differs) {
        body = &changed(*body, *next);
      }
      if (differs) ++next;
      bodies_.push_back(body);
    }
  }

  // A gear that was removed, or whose body was, comes back with the values of the scene; others keep theirs.
  void gears() {
    for (const std::string& name : a_.difference.gone_gears) {
      if (Gear* const gone = a_.world.find_gear(name)) a_.world.remove_gear(*gone);
    }
    std::vector<Gear*> order;
    for (std::size_t i = 0; i < a_.now.gears.size(); i++) {
      const GearDescription& now = a_.now.gears[i];
      const Gear& described = *a_.draft.gears()[i];
      Joint* const a = joint_of(now.body_a, now.joint_a);
      Joint* const b = joint_of(now.body_b, now.joint_b);
      LIMBER_CHECK(a != nullptr && b != nullptr);
      Gear* live = a_.world.find_gear(now.name);
      if (live != nullptr && (&live->joint_a() != a || &live->joint_b() != b)) {
        a_.world.remove_gear(*live);
        live = nullptr;
      }
      if (live == nullptr) {
        const Result<Gear*> made = a_.world.add_gear(now.name, *a, *b, described.ratio(), described.offset());
        LIMBER_CHECK(made.ok());
        live = *made;
        set_rows(described.id(), live->id(), described_rows(Gear::table()));
      } else {
        const GearDifference& difference = a_.difference.gears[i];
        set_rows(described.id(), live->id(), difference.rows);
      }
      order.push_back(live);
    }
    a_.world.order_gears(order);
  }

  Joint* joint_of(const std::string& body, const std::string& joint) const {
    for (Body* const each : bodies_) {
      if (each->name() == body) return each->find_joint(joint);
    }
    return nullptr;
  }

  // new, or back after it was removed, or one of the performance that the scene now describes
  Body* newcomer(std::size_t i) {
    const Body& described = *a_.draft.bodies()[i];
    Body* const stranger = a_.world.find_body(described.name());
    if (stranger == nullptr) return *a_.world.copy_body(described, described.name());
    BodyDifference difference = compare_stranger(describe_body(*stranger), a_.now.bodies[i]);
    difference.now = i;
    return &changed(*stranger, difference);
  }

  Body& changed(Body& body, const BodyDifference& d) {
    const Body& described = *a_.draft.bodies()[d.now];
    Body& live = d.anew ? made_anew(body, described, d) : body;
    if (!d.anew && d.start) live.take_start_pose(described);
    set_rows(described.id(), live.id(), d.rows);
    for (std::size_t i = 0; i < d.parts.size(); i++)
      set_rows(described.parts()[i]->id(), live.parts()[i]->id(), d.parts[i]);
    for (std::size_t i = 0; i < d.joints.size(); i++)
      set_rows(described.joints()[i]->id(), live.joints()[i]->id(), d.joints[i]);
    for (std::size_t i = 0; i < d.motors.size(); i++)
      set_rows(described.motors()[i]->id(), live.motors()[i]->id(), d.motors[i]);
    for (const PairDescription& pair : d.pairs) {
      (void)live.edit_pair(*live.parts()[pair.a], *live.parts()[pair.b], pair.edit);
    }
    move(live, described, d);
    return live;
  }

  Body& made_anew(Body& body, const Body& described, const BodyDifference& d) {
    const Keepsakes keepsakes(body);
    keep_behaviors(body, kept_behaviors_);
    Body& live = a_.world.rebuild_body(body, described, d.joints_start_anew);
    keepsakes.give_pairs_to(live);
    keepsakes.give_to(store_, live.id(), "", d.rows);
    for (std::size_t i = 0; i < d.parts.size(); i++)
      keepsakes.give_to(store_, live.parts()[i]->id(), live.parts()[i]->name(), d.parts[i]);
    for (std::size_t i = 0; i < d.joints.size(); i++)
      keepsakes.give_to(store_, live.joints()[i]->id(), live.joints()[i]->name(), d.joints[i]);
    for (std::size_t i = 0; i < d.motors.size(); i++)
      keepsakes.give_to(store_, live.motors()[i]->id(), live.motors()[i]->name(), d.motors[i]);
    return live;
  }

  static void move(Body& live, const Body& described, const BodyDifference& d) {
    const Pose before = live.pose();
    const Pose wanted = described.pose();
    const Pose to{d.position ? wanted.position : before.position, d.rotation ? wanted.rotation : before.rotation};
    if (live.parts().empty()) return live.set_pose(to);
    if (d.position || d.rotation) {
      const Pose moved = to * before.inverse();
      const std::size_t root_tree = live.trees().front();
      const auto along = [&](std::size_t first) { live.move_tree(first, moved * live.parts()[first]->pose()); };
      if (root_tree == 0) {
        live.move_tree(0, to);
      } else {
        along(root_tree);
      }
      for (const std::size_t first : d.trees_along) along(first);
    }
    for (const std::size_t first : d.trees_placed) live.move_tree(first, described.parts()[first]->pose());
  }

  const Application& a_;
  Store& store_;
  std::vector<Shape*> shapes_;
  std::vector<Body*> bodies_;
  std::vector<KeptBehavior> kept_behaviors_;  // of bodies that are made anew
};

}  // namespace

LiveThings things_of(const World& world) {
  LiveThings things;
  for (const auto& shape : world.shapes()) things.shapes.push_back(shape->id());
  for (const auto& body : world.bodies()) things.bodies.push_back(body->id());
  return things;
}

void apply(const Application& application, LiveThings& things) { Applying(application).run(things); }

}  // namespace limber
