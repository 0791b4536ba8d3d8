// C API: texts and names, random numbers, a scene's parameters, error reports.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/log/log.h"
#include "base/text.h"
#include "properties/units.h"
#include "script/api/noise.h"
#include "script/api/script_context.h"
#include "script/behaviors/behavior_scripts.h"
#include "script/vm/guard.h"
#include "sim/behavior/behavior_list.h"
#include "sim/visuals/visuals.h"

namespace limber::script::calls {

namespace {

Random& generator_of(ScriptContext& c, std::int32_t slot, std::int32_t generation) {
  if (slot < -1) return c.behaviors->generator(-2 - slot);
  const NodeId id = id_of(slot, generation);
  // an rng object that outlives its behavior draws from the scene's generator
  if (slot < 0 || !c.alive(id)) return c.generator();
  auto& behavior = *static_cast<sim::Behavior*>(c.world->store().object(id));
  behavior.save_for_rollback();
  return behavior.random();
}

}  // namespace

std::int32_t hint(void* c, const char* written, std::int32_t length, const char* names, std::int32_t names_length) {
  std::vector<std::string_view> list;
  if (names_length > 0) list = split(text_of(names, names_length), '\n');
  return context_of(c).set_text(name_hint(printable(text_of(written, length)), list));
}

std::int32_t is_pattern(void*, const char* text, std::int32_t length) {
  return limber::is_pattern(text_of(text, length)) ? 1 : 0;
}

std::int32_t matches(void*, const char* pattern, std::int32_t pattern_length, const char* name, std::int32_t length) {
  return pattern_match(text_of(pattern, pattern_length), text_of(name, length)) ? 1 : 0;
}

const LimberMatch* match(void* c) {
  return reinterpret_cast<const LimberMatch*>(&context_of(c).pattern_matcher.last_match());
}

std::int32_t find_match(void* c, const char* text, std::int32_t length, const char* pattern,
                        std::int32_t pattern_length, std::int32_t from, std::int32_t anchors) {
  ScriptContext& context = context_of(c);
  switch (context.pattern_matcher.find(text_of(text, length), text_of(pattern, pattern_length),
                                       static_cast<std::size_t>(from), anchors != 0)) {
    case SearchResult::found:
      return 1;
    case SearchResult::not_found:
      return 0;
    case SearchResult::bad_pattern:
      return context.reject(context.pattern_matcher.fault());
    case SearchResult::too_long:
      break;
  }
  return context.reject(
      "this pattern takes too many steps on this text; make it simpler (fewer * + - next to each other), or the text "
      "shorter");
}

std::int32_t find_plain(void* c, const char* text, std::int32_t length, const char* wanted, std::int32_t wanted_length,
                        std::int32_t from) {
  const std::size_t at = context_of(c).pattern_matcher.find_plain(text_of(text, length), text_of(wanted, wanted_length),
                                                                  static_cast<std::size_t>(from));
  return at == std::string_view::npos ? -1 : static_cast<std::int32_t>(at);
}

void print(void* c, const char* text, std::int32_t length) { context_of(c).host.print(text_of(text, length)); }

void warn(void*, const char* text, std::int32_t length) { log_line(LogLevel::warning, text_of(text, length)); }

void report(void* c) {
  ScriptContext& context = context_of(c);
  const ScriptFault& fault = context.guard->fault();
  context.host.script_error(fault.file, fault.line, fault.text);
}

std::int32_t stopped(void* c) {
  ScriptContext& context = context_of(c);
  if (!context.guard->stopped()) return 0;
  context.set_text(std::string(context.guard->stop_file()));
  context.answer.number[0] = context.guard->stop_line();
  return 1;
}

std::int32_t fault(void* c) {
  ScriptContext& context = context_of(c);
  return context.set_text(context.guard->fault().text);
}

std::int32_t stop_text(void* c) {
  ScriptContext& context = context_of(c);
  return context.set_text(context.guard->stop_text());
}

std::int32_t read_lib(void* c, std::int32_t of, const char* name, std::int32_t length) {
  ScriptContext& context = context_of(c);
  BehaviorFile* const behavior = of < 0 ? nullptr : &context.behaviors->file(of);
  const Result<std::string> file =
      behavior == nullptr ? context.sources->find_lib(context.files, text_of(name, length))
                          : context.sources->find_behavior_lib(context.files, text_of(name, length), behavior->path);
  if (!file) return context.reject(file.error());
  Result<std::string> text = context.sources->text(*file);
  if (!text) return context.reject(text.error());
  // the name for messages on a line of its own, then the text
  return context.set_text(context.files.display_path(*file) + "\n" + *text);
}

double random_uniform(void* c, std::int32_t slot, std::int32_t generation) {
  return generator_of(context_of(c), slot, generation).uniform();
}

double random_normal(void* c, std::int32_t slot, std::int32_t generation) {
  return generator_of(context_of(c), slot, generation).normal();
}

std::int32_t random_direction(void* c, std::int32_t slot, std::int32_t generation) {
  ScriptContext& context = context_of(c);
  const Vec3 v = generator_of(context, slot, generation).direction();
  for (int i = 0; i < 3; i++) context.answer.number[i] = v[i];
  return kOk;
}

double noise(void*, double x, double y, double z) { return gradient_noise(x, y, z); }

double min(double x, double y) { return y < x ? y : x; }
double max(double x, double y) { return y > x ? y : x; }

double clamp(double x, double lo, double hi) {
  if (x < lo) return lo;
  return x > hi ? hi : x;
}

std::int32_t camera_glide(void* c, double eye_x, double eye_y, double eye_z, double target_x, double target_y,
                          double target_z, double seconds) {
  const ScriptContext& context = context_of(c);
  const Vec3 eye(eye_x, eye_y, eye_z);
  const Vec3 target(target_x, target_y, target_z);
  if (!is_finite(eye) || !is_finite(target)) return kRejected;
  context.world->visuals().camera_moves().glide(eye, target, seconds);
  return kOk;
}

void camera_follow(void* c, std::int32_t slot, std::int32_t generation) {
  context_of(c).world->visuals().camera_moves().follow(slot < 0 ? NodeId{} : id_of(slot, generation));
}

void request_reset(void* c) { context_of(c).effects.request_reset(); }

void request_panic(void* c) { context_of(c).effects.request_panic(); }

void param_begin(void* c) { context_of(c).arguments.parameters.clear(); }

std::int32_t param_property(void* c, const char* name, std::int32_t length, std::int32_t type, const double* initial,
                            const double* low, const double* high) {
  ScriptContext& context = context_of(c);
  const std::string_view wanted = text_of(name, length);
  if (context.arguments.parameters.size() >= 64) return context.reject("params: more than 64 parameters");
  for (const Property& other : context.arguments.parameters) {
    if (same_name(other.name, wanted)) {
      return context.reject(fmt::format("params: '{}' and '{}' are the same name (case and underscores don't count)",
                                        other.name, printable(wanted)));
    }
  }
  Property property;
  property.name = std::string(wanted);
  property.type = static_cast<PropertyType>(type);
  const std::size_t width = width_of(property.type);
  for (std::size_t i = 0; i < width; i++) {
    if (!(low[i] <= high[i])) return context.reject(fmt::format("params: '{}' has a min above its max", wanted));
    property.initial[i] = std::clamp(initial[i], low[i], high[i]);
  }
  property.min = *std::min_element(low, low + width);
  property.max = *std::max_element(high, high + width);
  const auto differ = [&](const double* v) { return std::any_of(v, v + width, [&](double x) { return x != v[0]; }); };
  if (differ(low) || differ(high)) {
    property.axis_min.assign(low, low + width);
    property.axis_max.assign(high, high + width);
  }
  context.arguments.parameters.push_back(std::move(property));
  return kOk;
}

void param_doc(void* c, const char* text, std::int32_t length) {
  context_of(c).arguments.parameters.back().doc = printable(text_of(text, length));
}

std::int32_t param_unit(void* c, const char* text, std::int32_t length) {
  ScriptContext& context = context_of(c);
  const std::string_view unit = text_of(text, length);
  if (!known_unit(unit)) {
    std::vector<std::string_view> known;
    for (const Unit& each : units()) known.push_back(each.symbol);
    return context.reject(fmt::format("params: '{}': unknown unit '{}'{}", context.arguments.parameters.back().name,
                                      printable(unit), name_hint(unit, known)));
  }
  context.arguments.parameters.back().unit = std::string(unit);
  return kOk;
}

void param_rerun(void* c) {
  ScriptContext& context = context_of(c);
  context.params.rerun_properties |= std::uint64_t{1} << (context.arguments.parameters.size() - 1);
}

void param_step(void* c, double step) { context_of(c).arguments.parameters.back().step = step; }

void param_choice(void* c, const char* text, std::int32_t length) {
  Property& property = context_of(c).arguments.parameters.back();
  property.choices.emplace_back(text_of(text, length));
  property.max = static_cast<double>(property.choices.size()) - 1;
}

std::int32_t param_done(void* c) {
  ScriptContext& context = context_of(c);
  context.params.node = std::make_unique<ParamsNode>(context.world->store(), std::move(context.arguments.parameters));
  context.arguments.parameters.clear();
  context.params.node->carry_over(context.params.previous);
  return params_node(c);
}

std::int32_t params_node(void* c) {
  ScriptContext& context = context_of(c);
  const NodeId id = context.params.node != nullptr ? context.params.id() : context.params.live;
  if (!context.alive(id)) return kRemoved;
  context.set_id(id);
  Store& store = context.world->store();
  context.answer.count = static_cast<std::int32_t>(store.table_number(store.table(id)));
  return kOk;
}

void cancel_timer(void* c, std::int32_t run, std::int32_t number) {
  context_of(c).timers.cancellations.push_back({run, number});
}

void handles(void* c, std::int32_t** ids, std::int32_t count) {
  context_of(c).arguments.handle_ids = {ids, static_cast<std::size_t>(count)};
}

std::int32_t beat_reached(void* c, double every) {
  ScriptContext& context = context_of(c);
  const std::optional<double> reached = context.world->behaviors().clock().reached(every);
  if (!reached) return kRejected;
  context.answer.number[0] = *reached;
  return kOk;
}

}  // namespace limber::script::calls
