// TendonList: adding, removing, copying and reattaching tendons.
#include "sim/tendons/tendon_list.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/text.h"
#include "sim/world/body.h"
#include "sim/world/part.h"
#include "sim/world/world.h"

namespace limber::sim {

namespace {

constexpr double kMaxCoordinate = 1e4;  // m
constexpr const char* kGroup = "tendon";

NodeId group_of_tendons(const Body& body) { return body.store().child(body.id(), kGroup); }

std::optional<std::string> points_error(std::span<const Tendon::Point> points) {
  if (points.size() < 2 || points.size() > Tendon::kMaxPoints)
    return fmt::format("needs 2 .. {} points, not {}", Tendon::kMaxPoints, points.size());
  for (std::size_t i = 0; i < points.size(); i++) {
    const Vec3& p = points[i].position;
    if (std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <= kMaxCoordinate && is_finite(p)) continue;
    return fmt::format("point {}: its coordinates must be {} .. {} m", i + 1, -kMaxCoordinate, kMaxCoordinate);
  }
  const Part* const first = points.front().part;
  if (std::ranges::all_of(points, [&](const Tendon::Point& p) { return p.part == first; }))
    return fmt::format("all points are on the part '{}'; a tendon connects at least two parts", first->name());
  return {};
}

}  // namespace

std::vector<Tendon*> TendonList::of(const Body& body) const {
  std::vector<Tendon*> found;
  for (const auto& tendon : tendons_) {
    if (&tendon->body() == &body) found.push_back(tendon.get());
  }
  return found;
}

Tendon* TendonList::find(const Body& body, std::string_view name) const {
  const NodeId group = group_of_tendons(body);
  const NodeId id = group.null() ? NodeId{} : body.store().child(group, name);
  return id.null() ? nullptr : static_cast<Tendon*>(body.store().object(id));
}

Tendon& TendonList::add_unchecked(Body& body, std::string name, std::vector<Tendon::Point> points) {
  NodeId group = group_of_tendons(body);
  if (group.null()) {
    group = body.store().add_group(body.id(), kGroup);
    world_.transaction().record(
        [](void* owner, std::size_t) {
          const Body& of = *static_cast<Body*>(owner);
          of.store().remove(group_of_tendons(of));
        },
        &body);
  }
  tendons_.push_back(std::make_unique<Tendon>(body, group, std::move(name), std::move(points)));
  world_.transaction().record_added(tendons_);
  return *tendons_.back();
}

Result<Tendon*> TendonList::add(Body& body, std::string name, std::vector<Tendon::Point> points) {
  if (const auto fault = name_error(name)) return Error{fmt::format("tendon: {}", *fault)};
  if (find(body, name) != nullptr) return Error{fmt::format("there is a tendon '{}' already; names are unique", name)};
  if (const auto fault = points_error(points))
    return Error{fmt::format("tendon '{}/{}': {}", body.name(), name, *fault)};
  for (const Tendon::Point& point : points) point.part->flush();  // Bullet must have the poses that were set
  return &add_unchecked(body, std::move(name), std::move(points));
}

void TendonList::remove(Tendon& tendon) {
  const auto at = std::ranges::find_if(tendons_, [&](const auto& each) { return each.get() == &tendon; });
  if (at == tendons_.end()) return;
  if (world_.transaction().active())
    return world_.transaction().hide(tendons_, static_cast<std::size_t>(at - tendons_.begin()));
  tendons_.erase(at);
}

void TendonList::remove_from(const Body& body) {
  for (std::size_t i = tendons_.size(); i-- > 0;) {
    if (tendons_[i]->uses(body)) remove(*tendons_[i]);
  }
}

void TendonList::move_to_front(const std::vector<Tendon*>& first) {
  const auto rank = [&](const std::unique_ptr<Tendon>& tendon) {
    return std::find(first.begin(), first.end(), tendon.get()) - first.begin();
  };
  std::stable_sort(tendons_.begin(), tendons_.end(), [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
}

void TendonList::copy(const Body& source, Body& copy) {
  const bool same_world = &source.world() == &copy.world();
  for (const Tendon* from : source.world().tendons().of(source)) {
    std::vector<Tendon::Point> points(from->points().begin(), from->points().end());
    bool complete = true;
    for (Tendon::Point& point : points) {
      if (&point.part->body() == &source) {
        point.part = copy.find_part(point.part->name());
      } else {
        complete = complete && same_world;
      }
    }
    if (!complete) continue;
    Tendon& to = add_unchecked(copy, from->name(), std::move(points));
    const Store& store = source.store();
    const PropertyTable& table = Tendon::table();
    std::copy_n(store.persistent_block(from->id()), table.persistent_width(), copy.store().persistent_block(to.id()));
    std::copy_n(store.transient_block(from->id()), table.transient_width(), copy.store().transient_block(to.id()));
    copy.store().mark_explicitly_set(to.id(), store.explicitly_set(from->id()));
    to.apply_settings();
  }
}

void TendonList::update() {
  for (const auto& tendon : tendons_) tendon->update_constraint();
}

void TendonList::publish() {
  for (const auto& tendon : tendons_) tendon->publish();
}

std::vector<TendonList::Detached> TendonList::detach(const Body& body) {
  std::vector<Detached> detached;
  std::vector<std::unique_ptr<Tendon>> kept;
  for (std::unique_ptr<Tendon>& tendon : tendons_) {
    if (!tendon->uses(body)) {
      kept.push_back(std::move(tendon));
      continue;
    }
    tendon->remove_constraint();
    Detached& out = detached.emplace_back();
    out.name = tendon->name();
    for (const Tendon::Point& point : tendon->points()) {
      const bool on_body = &point.part->body() == &body;
      out.points.push_back({on_body ? nullptr : point.part, point.position});
      out.parts.push_back(on_body ? point.part->name() : std::string());
    }
    const double* const values = body.store().persistent_block(tendon->id());
    out.values.assign(values, values + Tendon::table().persistent_width());
    out.explicitly_set = body.store().explicitly_set(tendon->id());
    if (&tendon->body() != &body) out.tendon = std::move(tendon);
  }
  tendons_ = std::move(kept);
  return detached;
}

void TendonList::attach(std::vector<Detached> detached, Body& replacement) {
  for (Detached& entry : detached) {
    bool complete = true;
    for (std::size_t i = 0; i < entry.points.size(); i++) {
      Part*& part = entry.points[i].part;
      if (part == nullptr) part = replacement.find_part(entry.parts[i]);
      complete = complete && part != nullptr;
    }
    if (entry.tendon != nullptr) {
      if (!complete) continue;
      entry.tendon->replace_points(std::move(entry.points));
      tendons_.push_back(std::move(entry.tendon));
      continue;
    }
    Tendon* tendon = find(replacement, entry.name);
    if (tendon == nullptr && complete && !points_error(entry.points))
      tendon = &add_unchecked(replacement, entry.name, std::move(entry.points));
    if (tendon == nullptr) continue;
    std::copy(entry.values.begin(), entry.values.end(), replacement.store().persistent_block(tendon->id()));
    replacement.store().mark_explicitly_set(tendon->id(), entry.explicitly_set);
    tendon->apply_settings();
  }
}

void TendonList::serialize(Archive& archive) {
  for (const auto& tendon : tendons_) tendon->serialize(archive);
}

}  // namespace limber::sim
