// ScenePatch: applies a scene diff to a world: shapes, bodies, values, poses, order.
#include "engine/reload/scene_patch.h"

#include <algorithm>
#include <bit>
#include <string>
#include <utility>

#include "base/check.h"
#include "base/log/log.h"
#include "engine/reload/behavior_patch.h"
#include "sim/behavior/behavior_list.h"
#include "sim/fixtures/fixture_list.h"
#include "sim/gears/gear_list.h"
#include "sim/mocap/mocap_list.h"
#include "sim/shapes/shape_list.h"
#include "sim/state/body_trees.h"
#include "sim/state/rebuild.h"
#include "sim/tendons/tendon_list.h"
#include "sim/visuals/visuals.h"
#include "sim/world/body.h"
#include "sim/world/joint.h"
#include "sim/world/motor.h"
#include "sim/world/part.h"

namespace limber::engine {

namespace {

template <class T>
T* find_alive(const sim::World& world, NodeId id) {
  const Store& store = world.store();
  if (!store.alive(id) || &store.table(id) != &T::table()) return nullptr;
  return static_cast<T*>(store.object(id));
}

std::uint64_t part_property_bit(std::string_view property) {
  return std::uint64_t{1} << sim::Part::table().at(property).index;
}

// Saves the values of a body's objects while the body is rebuilt, by class and name.
class SavedValues {
 public:
  explicit SavedValues(const sim::Body& body) {
    for (const NodeId id : objects_of(body)) save(body.store(), id);
    for (const sim::PartPair& pair : body.pairs().list()) {
      pairs_.push_back({body.parts()[pair.a]->name(), body.parts()[pair.b]->name(), pair.edit});
    }
  }

  // Restores the edits of pairs if both parts still exist.
  void restore_pairs_to(sim::Body& body) const {
    for (const SavedPair& pair : pairs_) {
      const sim::Part* const a = body.find_part(pair.a);
      const sim::Part* const b = body.find_part(pair.b);
      if (a != nullptr && b != nullptr) (void)body.pairs().edit(*a, *b, pair.edit);
    }
  }

  // Restores the saved values, except the properties of `except`, and velocities, which belong to the body state.
  void restore_to(Store& store, NodeId id, std::uint64_t except) const {
    const PropertyTable& table = store.table(id);
    const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) {
      return entry.table == &table && entry.name == store.name(id);
    });
    if (found == entries_.end()) return;
    if (&table == &sim::Part::table())
      except |= part_property_bit("linear_velocity") | part_property_bit("angular_velocity");
    const std::uint64_t mask = described_mask(table) & ~except;
    for (const Property& property : table.properties()) {
      if ((mask >> property.index & 1u) == 0) continue;
      const double* const saved = (property.transient ? found->transient : found->persistent).data() + property.offset;
      if (std::equal(saved, saved + property.width, std::as_const(store).values(id, property))) continue;
      (void)store.set(id, property, {saved, property.width});  // may fail, for example if a mass can no longer be set
    }
  }

 private:
  struct SavedPair {
    std::string a, b;
    sim::PairEdit edit;
  };
  struct Entry {
    const PropertyTable* table;
    std::string name;
    std::vector<double> persistent, transient;
  };
  void save(const Store& store, NodeId id) {
    const PropertyTable& table = store.table(id);
    const double* const persistent = store.persistent_block(id);
    const double* const transient = store.transient_block(id);
    entries_.push_back({&table,
                        store.name(id),
                        {persistent, persistent + table.persistent_width()},
                        {transient, transient + table.transient_width()}});
  }

  std::vector<Entry> entries_;
  std::vector<SavedPair> pairs_;
};

class PatchApplier {
 public:
  explicit PatchApplier(const ScenePatch& patch) : patch_(patch), store_(patch.world.store()) {}

  void run(LiveObjects& objects) {
    const std::array<NodeId, kSingleNodes> candidates = single_nodes(patch_.candidate);
    const std::array<NodeId, kSingleNodes> live = single_nodes(patch_.world);
    for (std::size_t i = 0; i < kSingleNodes; i++) set_properties(candidates[i], live[i], patch_.diff.singles[i]);
    remove_bodies(objects);
    apply_shapes(objects);
    apply_bodies(objects);
    apply_gears();
    apply_tendons();
    apply_fixtures();
    apply_mocap();
    apply_behaviors(patch_, bodies_, saved_behaviors_);
    apply_routes();
    for (const std::size_t removed : patch_.diff.removed_shapes) {
      if (sim::Shape* const shape = find_alive<sim::Shape>(patch_.world, objects.shapes[removed]))
        patch_.world.shapes().remove(*shape);
    }
    patch_.world.shapes().move_to_front(shapes_);
    patch_.world.move_bodies_to_front(bodies_);
    objects = {};
    for (const sim::Shape* shape : shapes_) objects.shapes.push_back(shape->id());
    for (const sim::Body* body : bodies_) objects.bodies.push_back(body->id());
  }

 private:
  void set_properties(NodeId from, NodeId to, std::uint64_t mask) {
    const Store& source_store = patch_.candidate.store();
    for (; mask != 0; mask &= mask - 1) {
      const Property& property = store_.table(to).property(static_cast<std::uint32_t>(std::countr_zero(mask)));
      const double* const values = source_store.values(from, property);
      patch_.on_set(to, property);
      if (std::equal(values, values + property.width, std::as_const(store_).values(to, property))) continue;
      const Result<SetOutcome> set = store_.set(to, property, {values, property.width});
      LIMBER_CHECK(set.ok());
    }
  }

  void remove_bodies(const LiveObjects& objects) {
    for (const std::size_t removed : patch_.diff.removed_bodies) {
      if (sim::Body* const body = find_alive<sim::Body>(patch_.world, objects.bodies[removed]))
        patch_.world.remove_body(*body);
    }
  }

  void apply_shapes(const LiveObjects& objects) {
    auto next = patch_.diff.shapes.begin();
    for (std::size_t i = 0; i < patch_.now.shapes.size(); i++) {
      const std::optional<std::size_t> before = patch_.diff.old_shape_indices[i];
      const sim::Shape& source = *patch_.candidate.shapes().list()[i];
      sim::Shape* shape = before ? find_alive<sim::Shape>(patch_.world, objects.shapes[*before]) : nullptr;
      const bool differs = next != patch_.diff.shapes.end() && next->new_index == i;
      if (shape == nullptr) {
        shape = patch_.world.shapes().find(source.name());
        const bool is_new = shape == nullptr;
        if (is_new) shape = *patch_.world.shapes().add(source.name(), source.model());
        shape->assign_geometry(source);
        // a new shape gets all values, because colors of a URDF file are not explicitly set
        set_properties(source.id(), shape->id(),
                       is_new ? described_mask(sim::Shape::table()) : explicit_mask(patch_.now.shapes[i]->values));
      } else if (differs) {
        if (next->geometry_changed) shape->assign_geometry(source);
        set_properties(source.id(), shape->id(), next->changed);
      }
      if (differs) ++next;
      shapes_.push_back(shape);
    }
  }

  void apply_bodies(const LiveObjects& objects) {
    auto next = patch_.diff.bodies.begin();
    for (std::size_t i = 0; i < patch_.now.bodies.size(); i++) {
      const std::optional<std::size_t> before = patch_.diff.old_body_indices[i];
      const bool differs = next != patch_.diff.bodies.end() && next->new_index == i;
      sim::Body* body = before ? find_alive<sim::Body>(patch_.world, objects.bodies[*before]) : nullptr;
      if (body == nullptr) {
        body = add_body(i);
      } else if (differs) {
        body = &patch_body(*body, *next);
      }
      if (differs) ++next;
      bodies_.push_back(body);
    }
  }

  // A gear that was removed, or lost a body, is added again with the values of the scene; others keep their values.
  void apply_gears() {
    for (const std::string& name : patch_.diff.gears.removed) {
      if (sim::Gear* const removed = patch_.world.gears().find(name)) patch_.world.gears().remove(*removed);
    }
    std::vector<sim::Gear*> order;
    for (std::size_t i = 0; i < patch_.now.gears.size(); i++) {
      const GearDescription& now = patch_.now.gears[i];
      const sim::Gear& source = *patch_.candidate.gears().list()[i];
      sim::Joint* const a = joint_of(now.body_a, now.joint_a);
      sim::Joint* const b = joint_of(now.body_b, now.joint_b);
      LIMBER_CHECK(a != nullptr && b != nullptr);
      sim::Gear* live = patch_.world.gears().find(now.name);
      if (live != nullptr && (&live->joint_a() != a || &live->joint_b() != b)) {
        patch_.world.gears().remove(*live);
        live = nullptr;
      }
      if (live == nullptr) {
        const Result<sim::Gear*> added = patch_.world.gears().add(now.name, *a, *b, source.ratio(), source.offset());
        LIMBER_CHECK(added.ok());
        live = *added;
        set_properties(source.id(), live->id(), described_mask(sim::Gear::table()));
      } else {
        set_properties(source.id(), live->id(), patch_.diff.gears.list[i].changed);
      }
      order.push_back(live);
    }
    patch_.world.gears().move_to_front(order);
  }

  // The same for tendons; one through other points is made again.
  void apply_tendons() {
    sim::TendonList& tendons = patch_.world.tendons();
    for (const auto& [body, name] : patch_.diff.tendons.removed) {
      const sim::Body* const owner = body_named(body);
      if (sim::Tendon* const removed = owner == nullptr ? nullptr : tendons.find(*owner, name))
        tendons.remove(*removed);
    }
    std::vector<sim::Tendon*> order;
    for (std::size_t i = 0; i < patch_.now.tendons.size(); i++) {
      const TendonDescription& now = patch_.now.tendons[i];
      const NodeId source = patch_.candidate.tendons().list()[i]->id();
      sim::Body& body = *body_named(now.body);
      std::vector<sim::Tendon::Point> points;
      for (const TendonDescription::Point& point : now.points)
        points.push_back({body_named(point.body)->find_part(point.part), point.position});
      sim::Tendon* live = tendons.find(body, now.name);
      if (live != nullptr && !same_points(*live, points)) {
        tendons.remove(*live);
        live = nullptr;
      }
      if (live == nullptr) {
        const Result<sim::Tendon*> added = tendons.add(body, now.name, std::move(points));
        LIMBER_CHECK(added.ok());
        live = *added;
        set_properties(source, live->id(), described_mask(sim::Tendon::table()));
      } else {
        set_properties(source, live->id(), patch_.diff.tendons.list[i].changed);
      }
      order.push_back(live);
    }
    tendons.move_to_front(order);
  }

  // The same for fixtures; one with another profile or other targets is made again. Removes all of these first, so that
  // their channels are free.
  void apply_fixtures() {
    sim::FixtureList& fixtures = patch_.world.visuals().fixtures();
    for (const std::string& name : patch_.diff.fixtures.removed) {
      if (sim::Fixture* const removed = fixtures.find(name)) fixtures.remove(*removed);
    }
    const auto changed = [](const FixtureDescription& now, const sim::Fixture& live) {
      return !(live.profile() == *now.profile) || live.targets() != now.targets;
    };
    for (const FixtureDescription& now : patch_.now.fixtures) {
      sim::Fixture* const live = fixtures.find(now.name);
      if (live != nullptr && changed(now, *live)) fixtures.remove(*live);
    }
    std::vector<sim::Fixture*> order;
    for (std::size_t i = 0; i < patch_.now.fixtures.size(); i++) {
      const FixtureDescription& now = patch_.now.fixtures[i];
      const NodeId source = patch_.candidate.visuals().fixtures().list()[i]->id();
      sim::Fixture* live = fixtures.find(now.name);
      if (live == nullptr) {
        live = &fixtures.add_described(now.name, now.profile, now.targets);
        set_properties(source, live->id(), described_mask(sim::Fixture::table()));
      } else {
        set_properties(source, live->id(), patch_.diff.fixtures.list[i].changed);
      }
      order.push_back(live);
    }
    fixtures.move_to_front(order);
  }

  // A source with another setup is made again; the joints that the script uses are added to the others.
  void apply_mocap() {
    sim::MocapList& sources = patch_.world.sensing().mocap();
    for (const std::string& name : patch_.diff.mocap.removed) {
      if (const sim::MocapSource* const removed = sources.find(name)) sources.remove(*removed);
    }
    for (const MocapDescription& now : patch_.now.mocap) {  // all of them first: a new one may receive their messages
      const sim::MocapSource* const live = sources.find(now.name);
      if (live != nullptr && !(*live->setup() == *now.setup)) sources.remove(*live);
    }
    std::vector<sim::MocapSource*> order;
    for (std::size_t i = 0; i < patch_.now.mocap.size(); i++) {
      const MocapDescription& now = patch_.now.mocap[i];
      const NodeId source = patch_.candidate.sensing().mocap().list()[i]->id();
      sim::MocapSource* live = sources.find(now.name);
      std::uint64_t changed = patch_.diff.mocap.list[i].changed;
      if (live == nullptr) {
        const Result<sim::MocapSource*> added = sources.add(now.name, now.setup);
        LIMBER_CHECK(added.ok());
        live = *added;
        changed = described_mask(sim::MocapSource::table());
      }
      for (const std::string& joint : now.joints) (void)live->expect(joint);
      set_properties(source, live->id(), changed);
      order.push_back(live);
    }
    sources.move_to_front(order);
  }

  // A route that the scene has given other addresses gets them; one that a controller has connected otherwise keeps its
  // own.
  void apply_routes() {
    sim::RouteList& routes = patch_.world.behaviors().routes();
    for (const std::string& name : patch_.diff.routes.removed) {
      if (sim::Route* const removed = routes.find(name)) routes.remove(*removed);
    }
    std::vector<sim::Route*> order;
    for (std::size_t i = 0; i < patch_.now.routes.size(); i++) {
      const RouteDescription& now = patch_.now.routes[i];
      const NodeId source = patch_.candidate.behaviors().routes().list()[i]->id();
      const ObjectDiff& diff = patch_.diff.routes.list[i];
      sim::Route* live = routes.find(now.name);
      if (live == nullptr) {
        const Result<sim::Route*> added = routes.add(now.name, now.from, now.to);
        if (!added) {
          log_warning("route '{}' was not added: {}", now.name, added.error());
          continue;
        }
        live = *added;
        set_properties(source, live->id(), described_mask(sim::Route::table()));
      } else {
        if (!diff.same_build) (void)routes.connect(*live, now.from, now.to);
        set_properties(source, live->id(), diff.changed);
      }
      order.push_back(live);
    }
    routes.move_to_front(order);
  }

  static bool same_points(const sim::Tendon& tendon, const std::vector<sim::Tendon::Point>& points) {
    return std::equal(points.begin(), points.end(), tendon.points().begin(), tendon.points().end(),
                      [](const sim::Tendon::Point& a, const sim::Tendon::Point& b) {
                        return a.part == b.part && a.position == b.position;
                      });
  }

  sim::Body* body_named(const std::string& name) const {
    const auto found = std::ranges::find_if(bodies_, [&](const sim::Body* body) { return body->name() == name; });
    return found == bodies_.end() ? nullptr : *found;
  }

  sim::Joint* joint_of(const std::string& body, const std::string& joint) const {
    const sim::Body* const found = body_named(body);
    return found == nullptr ? nullptr : found->find_joint(joint);
  }

  // Adds a body that is new or was removed, or adopts an unmanaged body of this name.
  sim::Body* add_body(std::size_t i) {
    const sim::Body& source = *patch_.candidate.bodies()[i];
    sim::Body* const unmanaged = patch_.world.find_body(source.name());
    if (unmanaged == nullptr) return *patch_.world.copy_body(source, source.name());
    BodyDiff diff = compare_unmanaged(describe_body(*unmanaged), patch_.now.bodies[i]);
    diff.new_index = i;
    return &patch_body(*unmanaged, diff);
  }

  sim::Body& patch_body(sim::Body& body, const BodyDiff& diff) {
    const sim::Body& source = *patch_.candidate.bodies()[diff.new_index];
    sim::Body& live = diff.rebuild ? rebuild(body, source, diff) : body;
    if (!diff.rebuild && diff.start_changed) live.recovery().save_start_pose(source);
    const std::vector<NodeId> from = objects_of(source);
    const std::vector<NodeId> to = objects_of(live);
    for (std::size_t i = 0; i < diff.changed.size(); i++) set_properties(from[i], to[i], diff.changed[i]);
    for (const PairDescription& pair : diff.pairs) {
      (void)live.pairs().edit(*live.parts()[pair.a], *live.parts()[pair.b], pair.edit);
    }
    move_body(live, source, diff);
    return live;
  }

  sim::Body& rebuild(sim::Body& body, const sim::Body& source, const BodyDiff& diff) {
    const SavedValues saved(body);
    save_behaviors(body, saved_behaviors_);
    sim::Body& live = sim::rebuild_body(patch_.world, body, source, diff.joints_to_reset);
    saved.restore_pairs_to(live);
    const std::vector<NodeId> objects = objects_of(live);
    for (std::size_t i = 0; i < objects.size(); i++) saved.restore_to(store_, objects[i], diff.changed[i]);
    return live;
  }

  static void move_body(sim::Body& live, const sim::Body& source, const BodyDiff& diff) {
    const Pose before = live.pose();
    const Pose target = source.pose();
    const Pose to{diff.position_changed ? target.position : before.position,
                  diff.rotation_changed ? target.rotation : before.rotation};
    if (live.parts().empty()) return live.set_pose(to);
    if (diff.position_changed || diff.rotation_changed) {
      const Pose moved = to * before.inverse();
      const std::size_t root_tree = sim::tree_roots(live).front();
      const auto move_along = [&](std::size_t first) {
        sim::move_tree(live, first, moved * live.parts()[first]->pose());
      };
      if (root_tree == 0) {
        sim::move_tree(live, 0, to);
      } else {
        move_along(root_tree);
      }
      for (const std::size_t first : diff.trees_with_root) move_along(first);
    }
    for (const std::size_t first : diff.trees_placed) sim::move_tree(live, first, source.parts()[first]->pose());
  }

  const ScenePatch& patch_;
  Store& store_;
  std::vector<sim::Shape*> shapes_;
  std::vector<sim::Body*> bodies_;
  std::vector<SavedBehavior> saved_behaviors_;  // of rebuilt bodies
};

}  // namespace

LiveObjects live_objects_of(const sim::World& world) {
  LiveObjects objects;
  for (const auto& shape : world.shapes().list()) objects.shapes.push_back(shape->id());
  for (const auto& body : world.bodies()) objects.bodies.push_back(body->id());
  return objects;
}

void apply(const ScenePatch& patch, LiveObjects& objects) { PatchApplier(patch).run(objects); }

}  // namespace limber::engine
