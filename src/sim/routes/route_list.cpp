// RouteList: adding and removing routes, their targets, and a tick.
#include "sim/routes/route_list.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "sim/state/world_transaction.h"

namespace limber::sim {

namespace {

Result<void> check_ends(std::string_view name, std::string_view from, std::string_view to) {
  const std::string subject = fmt::format("route '{}'", name);
  if (const Result<void> valid = check_route_address(subject + ": from", from); !valid) return valid;
  return check_route_address(subject + ": to", to);
}

double joined(RouteCombine combine, double before, double output) {
  if (combine == RouteCombine::sum) return before + output;
  return combine == RouteCombine::max ? std::max(before, output) : output;
}

}  // namespace

RouteList::RouteList(Store& store, NodeId parent) : store_(store), routes_(store, store.add_group(parent, "route")) {}

Result<Route*> RouteList::add(std::string name, std::string from, std::string to) {
  if (const Result<void> free = routes_.check_new_name("route", name); !free) return Error{free.error()};
  if (routes_.list().size() >= kMaxRoutes) return Error{fmt::format("there are {} routes, the most", kMaxRoutes)};
  if (const Result<void> valid = check_ends(name, from, to); !valid) return Error{valid.error()};
  Route& route =
      routes_.add(std::make_unique<Route>(*this, routes_.group(), std::move(name), std::move(from), std::move(to)));
  if (transaction_ != nullptr) transaction_->record_added(routes_.objects());
  outdated_ = true;
  return &route;
}

Result<void> RouteList::connect(Route& route, std::string from, std::string to) {
  if (const Result<void> valid = check_ends(route.name(), from, to); !valid) return valid;
  route.connect(std::move(from), std::move(to));
  outdated_ = true;
  return {};
}

void RouteList::remove(Route& route) {
  const std::size_t index = routes_.index_of(route);
  if (index == routes_.list().size()) return;
  outdated_ = true;
  const auto at = routes_.objects().begin() + static_cast<std::ptrdiff_t>(index);
  if (transaction_ != nullptr && transaction_->active()) {
    const NodeId id = route.id();
    hidden_.push_back({std::move(*at), id, index, store_.hide(id)});
    transaction_->record([](void* list, std::size_t) { static_cast<RouteList*>(list)->show_last(); }, this);
  }
  routes_.objects().erase(at);
}

// The guarded call that removed the route has failed.
void RouteList::show_last() {
  Hidden& last = hidden_.back();
  store_.show(last.id, last.sibling_index);
  routes_.objects().insert(routes_.objects().begin() + static_cast<std::ptrdiff_t>(last.index), std::move(last.route));
  hidden_.pop_back();
  outdated_ = true;
}

void RouteList::destroy_hidden() {
  for (Hidden& each : hidden_) {
    each.route.reset();
    store_.remove_hidden(each.id);
  }
  hidden_.clear();
}

void RouteList::move_to_front(const std::vector<Route*>& first) {
  routes_.move_to_front(first);
  outdated_ = true;
}

void RouteList::clear() {
  routes_.objects().clear();
  targets_.clear();
  outdated_ = true;
}

void RouteList::update_links() {
  if (!outdated_ && structure_version_ == store_.structure_version()) return;
  for (const auto& route : routes_.list()) {
    if (route->needs_links()) route->find_links();
  }
  find_targets();
  structure_version_ = store_.structure_version();
  outdated_ = false;
}

void RouteList::find_targets() {
  targets_.clear();
  std::map<std::tuple<std::uint32_t, std::uint32_t>, std::uint32_t> indices;  // by slot and property
  for (const auto& route : routes_.list()) {
    for (RouteLink& link : route->links()) {
      const auto [at, is_new] =
          indices.try_emplace({link.to.ref.node.slot, link.to.ref.property->index}, targets_.size());
      if (is_new) targets_.push_back({link.to.ref, {}, {}});
      link.target = at->second;
    }
  }
}

// Joins the outputs of a route to those of the routes before it.
void RouteList::join(const Route& route, std::vector<Target>& targets) {
  const std::span<const double> outputs = route.outputs();
  if (outputs.empty()) return;
  const RouteCombine combine = route.combine();
  std::size_t next = 0;
  for (const RouteLink& link : route.links()) {
    Target& target = targets[link.target];
    const std::size_t width = link.from.width();
    const std::size_t first = link.to.component == RouteEnd::kAll ? 0 : static_cast<std::size_t>(link.to.component);
    for (std::size_t i = 0; i < link.to.width(); i++) {
      const double output = outputs[next + (width == 1 ? 0 : i)];
      double& value = target.values[first + i];
      value = std::exchange(target.is_set[first + i], true) ? joined(combine, value, output) : output;
    }
    next += width;
  }
}

void RouteList::set_target(Target& target) {
  const Property& property = *target.ref.property;
  std::array<double, 4> now{};
  store_.get(target.ref.node, property, now.data());
  std::array<double, 4> wanted = now;
  for (std::size_t i = 0; i < property.width; i++) {
    if (!target.is_set[i]) continue;
    if (!std::isfinite(target.values[i])) return;
    wanted[i] = std::clamp(target.values[i], property.low(i), property.high(i));
  }
  // an equal value would only wake up what sleeps
  if (property.kind == PropertyKind::setting && !property.computed() && wanted == now) return;
  const Result<SetOutcome> set = store_.set(target.ref.node, property, {wanted.data(), property.width});
  if (set) return;
  for (const auto& route : routes_.list()) {
    const bool sets_it =
        std::ranges::any_of(route->links(), [&](const RouteLink& link) { return &targets_[link.target] == &target; });
    if (sets_it) route->report_rejected(set.error());
  }
}

void RouteList::apply(double dt) {
  if (routes_.list().empty()) return;
  update_links();
  for (const auto& route : routes_.list()) route->compute(dt);
  for (Target& target : targets_) target.is_set = {};
  for (const auto& route : routes_.list()) join(*route, targets_);
  for (Target& target : targets_) {
    if (std::ranges::any_of(target.is_set, [](bool set) { return set; })) set_target(target);
  }
}

void RouteList::serialize(Archive& archive) {
  for (const auto& route : routes_.list()) route->serialize(archive);
}

std::uint64_t RouteList::state_hash(std::uint64_t hash) const {
  for (const auto& route : routes_.list()) hash = route->state_hash(hash);
  return hash;
}

}  // namespace limber::sim
