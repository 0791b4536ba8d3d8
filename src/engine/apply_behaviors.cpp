// Behaviours and groups of a reload.
#include "engine/apply_behaviors.h"

#include <algorithm>
#include <bit>

#include "base/log.h"

namespace limber {

namespace {

KeptBehavior kept_of(const Behavior& behavior) {
  const Table& table = *behavior.type().table;
  const double* const values = std::as_const(behavior.store()).kept_block(behavior.id());
  return {behavior.body().name(), behavior.name(), behavior.type().name,
          behavior.setup(),       &table,          {values, values + table.kept_width()}};
}

class ApplyingBehaviors {
 public:
  ApplyingBehaviors(const Application& a, const std::vector<Body*>& bodies, const std::vector<KeptBehavior>& kept)
      : a_(a), bodies_(bodies), kept_(kept), list_(a.world.behaviors()) {}

  void run() {
    take_types();
    for (const auto& [body, name] : a_.difference.gone_behaviors) {
      if (Behavior* const gone = bodies_[body]->find_behavior(name)) list_.remove(*gone);
    }
    for (const std::string& name : a_.difference.gone_groups) {
      if (BehaviorGroup* const gone = list_.find_group(name)) list_.remove_group(*gone);
    }
    for (std::size_t i = 0; i < bodies_.size(); i++) {
      for (std::size_t k = 0; k < a_.now.bodies[i].behaviors.size(); k++) single(i, k);
    }
    strangers();
    for (std::size_t i = 0; i < a_.now.groups.size(); i++) group(i);
    for (std::size_t i = 0; i < bodies_.size(); i++) members(i);
    if (a_.difference.other_order || made_) list_.bring_into(a_.now.behavior_order);
  }

 private:
  // types of files: all of the draft's, and instances as these now are
  void take_types() {
    const BehaviorTypes& theirs = a_.draft.behaviors().types();
    BehaviorTypes& types = list_.types();
    std::vector<std::string> gone;
    for (const auto& type : types.all()) {
      if (!type->is_built_in && theirs.find(type->name) == nullptr) gone.push_back(type->name);
    }
    for (const auto& type : theirs.all()) {
      if (type->is_built_in) continue;
      (void)types.add(*type);  // the draft's list has taken it too
      list_.renew(type->name);
    }
    for (const std::string& name : gone) types.remove(name);
  }

  void set_rows(NodeId from, NodeId to, const Table& described, std::uint64_t rows) {
    const Store& theirs = a_.draft.store();
    Store& store = a_.world.store();
    for (; rows != 0; rows &= rows - 1) {
      const Row& row = described.row(static_cast<std::uint32_t>(std::countr_zero(rows)));
      const Row& live = store.table(to).at(row.name);
      a_.on_set(to, live);
      (void)store.set(to, live, {theirs.values(from, row), row.width});  // the draft's store has taken it
    }
  }

  // values of one that goes, for the one that comes in its place; those of `leave` are said otherwise
  void give(const KeptBehavior& from, const Behavior& to, std::uint64_t leave) {
    Store& store = a_.world.store();
    for (const Row& row : to.type().table->rows()) {
      if (!row.stored() || !row.writable() || (leave >> row.index & 1u) != 0) continue;
      const Row* const old = from.table->find(row.name);
      if (old == nullptr || !old->stored() || old->type != row.type) continue;
      (void)store.set(to.id(), row, {from.values.data() + old->offset, row.width});
    }
  }

  const KeptBehavior* kept(std::string_view body, std::string_view name) const {
    const auto found =
        std::find_if(kept_.begin(), kept_.end(), [&](const auto& k) { return k.body == body && k.name == name; });
    return found == kept_.end() ? nullptr : &*found;
  }

  void single(std::size_t body, std::size_t number) {
    const BehaviorDescription& now = a_.now.bodies[body].behaviors[number];
    if (now.of_group) return;
    const BehaviorDifference& difference = a_.difference.behaviors[body][number];
    const Behavior& described = *a_.draft.bodies()[body]->behaviors()[number];
    Behavior* live = bodies_[body]->find_behavior(now.name);
    const KeptBehavior* before = kept(bodies_[body]->name(), now.name);
    KeptBehavior replaced;
    const bool other =
        live != nullptr && (live->group() != nullptr || live->type().name != now.type || !(live->setup() == now.setup));
    if (other) {
      replaced = kept_of(*live);
      before = &replaced;
      list_.remove(*live);
      live = nullptr;
    }
    if (live == nullptr) {
      live = make(*bodies_[body], now.type, now.name, now.setup);
      if (live == nullptr) return;
      if (before != nullptr && difference.described) {
        give(*before, *live, difference.rows);
      } else {
        return set_rows(described.id(), live->id(), *now.table, said_rows(now.rows));
      }
    }
    set_rows(described.id(), live->id(), *now.table, difference.rows);
  }

  Behavior* make(Body& body, const std::string& type, const std::string& name, const BehaviorSetup& setup) {
    const Result<Behavior*> added = list_.add(body, type, name, setup);
    made_ = true;
    if (added) return *added;
    log_warning("behavior '{}/{}' goes: {}", body.name(), name, added.error());
    return nullptr;
  }

  // attached in callbacks to bodies that were made anew
  void strangers() {
    for (const KeptBehavior& k : kept_) {
      Body* const body = a_.world.find_body(k.body);
      if (body == nullptr || body->find_behavior(k.name) != nullptr || was_described(k)) continue;
      if (const Behavior* const behavior = make(*body, k.type, k.name, k.setup)) give(k, *behavior, 0);
    }
  }

  bool was_described(const KeptBehavior& k) const {
    return std::any_of(a_.before.bodies.begin(), a_.before.bodies.end(), [&](const BodyDescription& body) {
      return body.name == k.body && std::any_of(body.behaviors.begin(), body.behaviors.end(),
                                                [&](const BehaviorDescription& b) { return b.name == k.name; });
    });
  }

  void group(std::size_t number) {
    const GroupDescription& now = a_.now.groups[number];
    const BehaviorDifference& difference = a_.difference.groups[number];
    const BehaviorGroup& described = *a_.draft.behaviors().groups()[number];
    BehaviorGroup* live = list_.find_group(now.name);
    const bool other = live != nullptr && (live->type().name != now.type || !(live->setup() == now.setup));
    std::uint64_t rows = difference.rows;
    if (other) {
      list_.remove_group(*live);
      live = nullptr;
    }
    if (live == nullptr) {
      made_ = true;
      const Result<BehaviorGroup*> added = list_.add_group(now.type, now.name, now.setup);
      if (!added) return log_warning("group behavior '{}' goes: {}", now.name, added.error());
      live = *added;
      rows = said_rows(now.rows);
    }
    set_rows(described.id(), live->id(), *now.table, rows);
  }

  // what is said of single members
  void members(std::size_t body) {
    const std::vector<BehaviorDescription>& now = a_.now.bodies[body].behaviors;
    for (std::size_t k = 0; k < now.size(); k++) {
      const std::uint64_t rows = a_.difference.behaviors[body][k].rows;
      if (!now[k].of_group || rows == 0) continue;
      const Behavior* const live = bodies_[body]->find_behavior(now[k].name);
      if (live == nullptr || live->group() == nullptr) continue;
      set_rows(a_.draft.bodies()[body]->behaviors()[k]->id(), live->id(), *now[k].table, rows);
    }
  }

  const Application& a_;
  const std::vector<Body*>& bodies_;
  const std::vector<KeptBehavior>& kept_;
  BehaviorList& list_;
  bool made_ = false;
};

}  // namespace

void keep_behaviors(const Body& body, std::vector<KeptBehavior>& kept) {
  for (const Behavior* behavior : body.behaviors()) {
    if (behavior->group() == nullptr) kept.push_back(kept_of(*behavior));
  }
}

void apply_behaviors(const Application& application, const std::vector<Body*>& bodies,
                     const std::vector<KeptBehavior>& kept) {
  ApplyingBehaviors(application, bodies, kept).run();
}

}  // namespace limber
