// C API: tendons of bodies.
#include <string>
#include <utility>
#include <vector>

#include "base/text.h"
#include "script/api/script_context.h"
#include "sim/tendons/tendon_list.h"
#include "sim/world/body.h"
#include "sim/world/part.h"
#include "sim/world/world.h"

namespace limber::script::calls {

namespace {

constexpr std::int32_t kNumbersPerPoint = 5;  // slot and generation of the part, x, y, z

}  // namespace

std::int32_t add_tendon(void* c, std::int32_t slot, std::int32_t generation, const char* name, std::int32_t length,
                        const double* numbers, std::int32_t count) {
  ScriptContext& context = context_of(c);
  if (is_full(context)) return kRejected;
  sim::Body* const body = object_of<sim::Body>(context, id_of(slot, generation));
  if (body == nullptr) return kRemoved;
  std::vector<sim::Tendon::Point> points;
  for (std::int32_t i = 0; i < count; i++) {
    const double* const n = numbers + static_cast<std::ptrdiff_t>(kNumbersPerPoint) * i;
    sim::Part* const part =
        object_of<sim::Part>(context, id_of(static_cast<std::int32_t>(n[0]), static_cast<std::int32_t>(n[1])));
    if (part == nullptr) return kRemoved;
    points.push_back({part, {n[2], n[3], n[4]}});
  }
  const Result<sim::Tendon*> tendon =
      context.world->tendons().add(*body, std::string(text_of(name, length)), std::move(points));
  return tendon ? context.set_id((*tendon)->id()) : context.reject(tendon.error());
}

std::int32_t tendon_point(void* c, std::int32_t slot, std::int32_t generation, std::int32_t index) {
  ScriptContext& context = context_of(c);
  const sim::Tendon* const tendon = object_of<sim::Tendon>(context, id_of(slot, generation));
  if (tendon == nullptr) return kRemoved;
  if (index < 0 || index >= static_cast<std::int32_t>(tendon->points().size())) return kRejected;
  const sim::Tendon::Point& point = tendon->points()[static_cast<std::size_t>(index)];
  put(context.answer.number, point.position);
  return context.set_id(point.part->id());
}

}  // namespace limber::script::calls
