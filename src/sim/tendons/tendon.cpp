// Tendon: its properties, and its constraint.
#include "sim/tendons/tendon.h"

#include <algorithm>
#include <utility>

#include "sim/bullet/island_world.h"
#include "sim/bullet/joints/tendon_constraint.h"
#include "sim/tendons/tendon_list.h"
#include "sim/world/body.h"
#include "sim/world/part.h"
#include "sim/world/world.h"

namespace limber::sim {

namespace {

using namespace properties;

struct TendonProperties {
  const Property *enabled, *stiffness, *damping, *rest_length, *tension, *max_tension, *pushes, *length, *speed, *force;
};

const TendonProperties& tendon_properties() {
  static const auto at = [](const char* name) { return &Tendon::table().at(name); };
  static const TendonProperties found{at("enabled"), at("stiffness"),   at("damping"), at("rest_length"),
                                      at("tension"), at("max_tension"), at("pushes"),  at("length"),
                                      at("speed"),   at("force")};
  return found;
}

}  // namespace

const PropertyTable& Tendon::table() {
  static const PropertyTable table(
      "tendon", "/physics/body/<body>/tendon/<tendon>", "",
      {
          on_change<&Tendon::apply_settings>(boolean("enabled", true, "False: it pulls at nothing.")),
          on_change<&Tendon::apply_settings>(
              number("stiffness", "N/m", 10000, 0, 1e9, "Tension per stretch beyond the rest length.")),
          on_change<&Tendon::apply_settings>(
              number("damping", "N·s/m", 10, 0, 1e6, "Tension per speed at which it lengthens, while it is taut.")),
          on_change<&Tendon::apply_settings>(
              number("rest_length", "m", 1, 0, 1e4, "Length up to which it is slack; at its creation its length.")),
          on_change<&Tendon::apply_settings>(
              number("tension", "N", 0, 0, 1e9, "Tension that is added to that of its stretch, also while slack.")),
          on_change<&Tendon::apply_settings>(
              number("max_tension", "N", 0, 0, 1e9, "Largest tension; beyond it, the tendon slips. 0: no limit.")),
          on_change<&Tendon::apply_settings>(
              boolean("pushes", false, "True: a spring that also pushes when it is shorter than its rest length.")),
          number("radius", "m", 0.004, 0, 10, "Radius with which it is drawn; 0: invisible."),
          transient(readout(number("length", "m", 0, 0, kUnbounded, "Length of the line through its points."))),
          transient(readout(number("speed", "m/s", 0, -kUnbounded, kUnbounded,
                                   "Rate of change of its length; positive: it lengthens."))),
          transient(readout(number("force", "N", 0, -kUnbounded, kUnbounded,
                                   "Its tension, mean of the last tick; negative: it pushes."))),
          invokes<&Tendon::act_remove>(action("remove", 0, 0, "Removes the tendon.")),
      });
  return table;
}

Tendon::Tendon(Body& body, NodeId group, std::string name, std::vector<Point> points)
    : body_(body), id_(body.store().add(table(), group, std::move(name), this)), points_(std::move(points)) {
  make_constraint();
  const double now = length();
  store().mutable_values(id_, *tendon_properties().rest_length)[0] = now;
  store().transient_block(id_)[tendon_properties().length->offset] = now;
  apply_settings();
}

Tendon::~Tendon() {
  remove_constraint();
  store().remove(id_);
}

Store& Tendon::store() const { return body_.store(); }
const std::string& Tendon::name() const { return store().name(id_); }

bool Tendon::uses(const Body& body) const {
  return &body == &body_ || std::ranges::any_of(points_, [&](const Point& p) { return &p.part->body() == &body; });
}

double Tendon::length() const {
  double sum = 0;
  for (std::size_t i = 1; i < points_.size(); i++) {
    const Vec3 from = points_[i - 1].part->pose() * points_[i - 1].position;
    sum += glm::length(points_[i].part->pose() * points_[i].position - from);
  }
  return sum;
}

void Tendon::make_constraint() {
  std::vector<bullet::TendonPoint> on_bodies;
  for (const Point& point : points_) {
    on_bodies.push_back({&point.part->rigid(), point.part->geometry()->frame.inverse() * point.position});
  }
  const bullet::BulletMemory::Scope scope(&body_.world().bullet_memory());
  constraint_ = std::make_unique<bullet::TendonConstraint>(on_bodies);
}

void Tendon::replace_points(std::vector<Point> points) {
  remove_constraint();
  points_ = std::move(points);
  make_constraint();
  apply_settings();
}

void Tendon::wake() {
  for (const Point& point : points_) point.part->wake();
}

void Tendon::apply_settings() {
  const TendonProperties& p = tendon_properties();
  const auto value = [&](const Property* property) { return std::as_const(store()).values(id_, *property)[0]; };
  const bullet::TendonSettings settings{value(p.stiffness), value(p.damping),     value(p.rest_length),
                                        value(p.tension),   value(p.max_tension), value(p.pushes) != 0};
  if (!(settings == constraint_->settings())) wake();
  constraint_->set(settings);
}

void Tendon::update_constraint() {
  const bool enabled = std::as_const(store()).values(id_, *tendon_properties().enabled)[0] != 0;
  const bool active =
      enabled && std::ranges::all_of(points_, [](const Point& p) { return p.part->rigid().isInWorld(); });
  if (!active) return remove_constraint();
  if (std::exchange(state_.in_world, true)) return;
  body_.world().bullet().addConstraint(constraint_.get(), false);
  wake();
}

void Tendon::remove_constraint() {
  if (!std::exchange(state_.in_world, false)) return;
  wake();
  body_.world().bullet().removeConstraint(constraint_.get());
}

void Tendon::publish() {
  const TendonProperties& p = tendon_properties();
  const bullet::TendonConstraint::Measure now = constraint_->measure();
  double* const block = store().transient_block(id_);
  block[p.length->offset] = now.length;
  block[p.speed->offset] = now.speed;
  block[p.force->offset] = state_.in_world ? constraint_->applied() : 0;
}

Result<void> Tendon::act_remove(std::span<const double>) {
  body_.world().tendons().remove(*this);
  return {};
}

}  // namespace limber::sim
