// C API: lighting fixtures.
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "script/api/script_context.h"
#include "script/scene/sources.h"
#include "sim/fixtures/fixture_list.h"
#include "sim/visuals/visuals.h"
#include "sim/world/body.h"
#include "sim/world/part.h"
#include "sim/world/world.h"

namespace limber::script::calls {

namespace {

// Returns the profile of that name, or of a file if the name ends with ".fixture".
Result<std::shared_ptr<const sim::FixtureProfile>> profile_named(const ScriptContext& context, std::string_view name) {
  if (!name.ends_with(".fixture")) return sim::generic_fixture_profile(name);
  const Result<std::string> path = context.sources->find(context.files, name);
  if (!path) return Error{path.error()};
  const Result<std::string> text = context.sources->text(*path);
  if (!text) return Error{text.error()};
  return sim::parse_fixture_profile(std::string(name), *text);
}

}  // namespace

std::int32_t add_fixture(void* c, const char* name, std::int32_t length, const char* profile,
                         std::int32_t profile_length, double universe, double address, const double* targets,
                         std::int32_t count) {
  ScriptContext& context = context_of(c);
  if (is_full(context)) return kRejected;
  std::vector<sim::FixtureTarget> parts;
  for (std::int32_t i = 0; i < count; i++) {
    const double* const n = targets + static_cast<std::ptrdiff_t>(2) * i;
    const sim::Part* const part =
        object_of<sim::Part>(context, id_of(static_cast<std::int32_t>(n[0]), static_cast<std::int32_t>(n[1])));
    if (part == nullptr) return kRemoved;
    parts.push_back({part->body().name(), part->name()});
  }
  Result<std::shared_ptr<const sim::FixtureProfile>> found = profile_named(context, text_of(profile, profile_length));
  if (!found) return context.reject(found.error());
  sim::FixtureList::Place place;
  if (!std::isnan(universe)) place.universe = universe;
  if (!std::isnan(address)) place.address = address;
  const Result<sim::Fixture*> fixture = context.world->visuals().fixtures().add(
      std::string(text_of(name, length)), std::move(*found), std::move(parts), place);
  if (!fixture) return context.reject(fixture.error());
  Store& store = context.world->store();
  for (const auto& [given, property] : {std::pair(universe, "universe"), std::pair(address, "address")}) {
    if (!std::isnan(given) && context.answer.top_level != 0)
      store.mark_explicitly_set((*fixture)->id(), sim::Fixture::table().at(property));
  }
  return context.set_id((*fixture)->id());
}

std::int32_t fixture_target(void* c, std::int32_t slot, std::int32_t generation, std::int32_t index) {
  ScriptContext& context = context_of(c);
  const sim::Fixture* const fixture = object_of<sim::Fixture>(context, id_of(slot, generation));
  if (fixture == nullptr || index < 0 || index >= static_cast<std::int32_t>(fixture->targets().size()))
    return kRejected;
  const sim::FixtureTarget& target = fixture->targets()[static_cast<std::size_t>(index)];
  const sim::Body* const body = context.world->find_body(target.body);
  const sim::Part* const part = body == nullptr ? nullptr : body->find_part(target.part);
  return part == nullptr ? kRemoved : context.set_id(part->id());
}

std::int32_t fixture_text(void* c, std::int32_t slot, std::int32_t generation, std::int32_t which) {
  ScriptContext& context = context_of(c);
  const sim::Fixture* const fixture = object_of<sim::Fixture>(context, id_of(slot, generation));
  if (fixture == nullptr) return kRemoved;
  return context.set_text(std::string(which == 0 ? fixture->read_profile() : fixture->read_dmx()));
}

}  // namespace limber::script::calls
