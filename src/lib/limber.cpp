// The functions of limber.h: they check arguments, protect the state of the calling thread, and turn errors and
// exceptions into a status.
#include "lib/limber.h"

#include <cfenv>
#include <cmath>
#include <cstring>
#include <limits>
#include <new>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "base/build_info.h"
#include "base/log/log.h"
#include "base/math/fixed_math.h"
#include "lib/simulation.h"

namespace limber::lib {

namespace {

constexpr std::size_t kMaxValues = 65536;

std::string& error_text() {
  thread_local std::string text;
  return text;
}

limber_status fail(limber_status status, std::string_view text) {
  try {
    error_text() = text;
  } catch (const std::bad_alloc&) {
    error_text().clear();
  }
  return status;
}

// Sets the default rounding mode and floating-point flags, and restores those of the calling thread at its end.
class ArithmeticScope {
 public:
  ArithmeticScope() {
    std::fegetenv(&before_);
    fixed::reset_arithmetic();
  }
  ~ArithmeticScope() { std::fesetenv(&before_); }
  ArithmeticScope(const ArithmeticScope&) = delete;
  ArithmeticScope& operator=(const ArithmeticScope&) = delete;

 private:
  std::fenv_t before_{};
};

template <class Work>
limber_status catch_all(Work work) {
  try {
    const ArithmeticScope arithmetic;
    return work();
  } catch (const std::bad_alloc&) {
    return fail(LIMBER_NO_MEMORY, "not enough memory");
  } catch (const std::system_error& error) {
    return fail(LIMBER_NO_MEMORY, error.what());
  } catch (const std::exception& error) {
    return fail(LIMBER_INVALID_ARGUMENT, error.what());
  }
}

// Calls `work` with the simulation, if this thread may use it now.
template <class Work>
limber_status with(limber_sim* sim, Work work) {
  if (sim == nullptr) return fail(LIMBER_INVALID_ARGUMENT, "the simulation is null");
  Simulation& simulation = sim->simulation;
  if (!simulation.in_its_process())
    return fail(LIMBER_WRONG_PROCESS, "the simulation belongs to the parent process; create one after the fork");
  if (!simulation.try_enter())
    return fail(LIMBER_BUSY, "another call with this simulation is running; use it on one thread at a time");
  const limber_status status = catch_all([&] {
    const LogSink::Scope log(simulation.log());
    return work(simulation);
  });
  simulation.leave();
  return status;
}

template <class T, class Work>
limber_status with_values(limber_property* property, const T* values, std::size_t size, Work work) {
  if (property == nullptr) return fail(LIMBER_INVALID_ARGUMENT, "the property is null");
  return with(property->owner, [&](Simulation& simulation) {
    PropertyHandle& handle = property->handle;
    if (const Result<void> valid = handle.refresh(simulation.engine()); !valid)
      return fail(LIMBER_STALE, valid.error());
    if (size != handle.size() || values == nullptr)
      return fail(LIMBER_INVALID_ARGUMENT, fmt::format("{}: the array must have {} x {} numbers, got {}",
                                                       handle.address(0), handle.count(), handle.width(), size));
    return work(simulation, handle);
  });
}

template <class T>
limber_status read_values(limber_property* property, T* values, std::size_t size) {
  return with_values(property, values, size, [&](Simulation& simulation, PropertyHandle& handle) {
    handle.read(simulation.engine().store(), values);
    return LIMBER_OK;
  });
}

template <class T>
limber_status write_values(limber_property* property, const T* values, std::size_t size) {
  return with_values(property, values, size, [&](Simulation& simulation, PropertyHandle& handle) {
    const Result<void> written = handle.write(simulation.engine().store(), values);
    return written ? LIMBER_OK : fail(LIMBER_REJECTED, written.error());
  });
}

Result<Message> message_of(const char* address, const limber_value* values, std::size_t count) {
  if (address == nullptr || address[0] != '/') return Error{"the address of a message must begin with /"};
  if (count > kMaxValues) return Error{fmt::format("a message has at most {} values, got {}", kMaxValues, count)};
  if (values == nullptr && count > 0) return Error{"the values of the message are null"};
  Message message{address, {}};
  for (std::size_t i = 0; i < count; i++) {
    const limber_value& value = values[i];
    int kind = 0;  // may be none of the enumeration
    static_assert(sizeof kind == sizeof value.kind);
    std::memcpy(&kind, &value.kind, sizeof kind);
    switch (kind) {
      case LIMBER_NUMBER:
        message.args.push_back(Arg::of(value.number));
        break;
      case LIMBER_BOOLEAN:
        message.args.push_back(Arg::of(value.number != 0));
        break;
      case LIMBER_TEXT:
        if (value.text == nullptr) return Error{fmt::format("the text of value {} is null", i + 1)};
        message.args.push_back(Arg::of(value.text));
        break;
      case LIMBER_NIL:
        message.args.emplace_back();
        break;
      default:
        return Error{fmt::format("value {} has an unknown kind", i + 1)};
    }
  }
  return message;
}

}  // namespace

}  // namespace limber::lib

using limber::lib::fail;
using limber::lib::Simulation;
using limber::lib::with;

const char* limber_version(int* major, int* minor) {
  if (major != nullptr) *major = LIMBER_INTERFACE_MAJOR;
  if (minor != nullptr) *minor = LIMBER_INTERFACE_MINOR;
  static const std::string text(limber::version());
  return text.c_str();
}

const char* limber_data_folder(void) {
  try {
    return limber::lib::data_folder().c_str();
  } catch (const std::exception&) {
    return "";
  }
}

const char* limber_last_error(void) { return limber::lib::error_text().c_str(); }

limber_status limber_create(const limber_options* options, limber_sim** out) {
  if (options == nullptr || out == nullptr) return fail(LIMBER_INVALID_ARGUMENT, "options or out is null");
  if (options->size != sizeof(limber_options))
    return fail(LIMBER_INVALID_ARGUMENT, "options: begin with LIMBER_OPTIONS, which sets their size");
  *out = nullptr;
  return limber::lib::catch_all([&] {
    if (const limber::Result<void> valid = limber::lib::check_options(*options); !valid)
      return fail(LIMBER_INVALID_ARGUMENT, valid.error());
    limber::log_to_stderr(false);  // of threads that belong to no simulation
    limber::lib::ProgramLog log(options->log, options->log_context);
    const limber::LogSink::Scope scope(log);
    if (limber::fixed::bind_libm() == 0 && !limber::fixed::is_libm_replaced())
      limber::log_warning(
          "LuaJIT and Bullet use the mathematical functions of the C library here; results may differ from "
          "those of the program limber");
    auto sim = std::make_unique<limber_sim>(*options);
    if (const limber::Result<void> started = sim->simulation.start(); !started)
      return fail(LIMBER_SCENE_ERROR, started.error());
    *out = sim.release();
    return LIMBER_OK;
  });
}

// In a child process the threads of the simulation don't exist, so its memory is kept.
void limber_destroy(limber_sim* sim) {
  if (sim == nullptr) return;
  (void)with(sim, [&](Simulation& simulation) {
    for (limber_state& state : simulation.states()) simulation.engine().saved_states().discard(state.state);
    simulation.states().clear();
    return LIMBER_OK;
  });
  if (!sim->simulation.in_its_process() || !sim->simulation.try_enter()) return;
  (void)limber::lib::catch_all([&] {
    limber::lib::ProgramLog log = sim->simulation.log();
    const limber::LogSink::Scope scope(log);
    delete sim;
    return LIMBER_OK;
  });
}

limber_status limber_step(limber_sim* sim, uint64_t ticks) {
  return with(sim, [&](Simulation& simulation) {
    if (ticks > limber::lib::kMaxInteger)
      return fail(LIMBER_INVALID_ARGUMENT, fmt::format("the number of ticks must be at most 2^53, got {}", ticks));
    simulation.step(ticks);
    return LIMBER_OK;
  });
}

limber_status limber_reset(limber_sim* sim, const uint64_t* seed) {
  return with(sim, [&](Simulation& simulation) {
    std::optional<std::uint64_t> number;
    if (seed != nullptr) number = *seed;
    if (number.value_or(0) > limber::lib::kMaxInteger)
      return fail(LIMBER_INVALID_ARGUMENT, fmt::format("seed must be 0 to 2^53, got {}", *seed));
    return simulation.restart(number)
               ? LIMBER_OK
               : fail(LIMBER_SCENE_ERROR, "the scene has an error; its text is in the log (limber_options::log)");
  });
}

uint64_t limber_tick(const limber_sim* sim) { return sim == nullptr ? 0 : sim->simulation.world().tick(); }
double limber_time(const limber_sim* sim) { return sim == nullptr ? 0 : sim->simulation.world().time(); }
double limber_timestep(const limber_sim* sim) { return sim == nullptr ? 0 : sim->simulation.world().timestep(); }
uint64_t limber_faults(const limber_sim* sim) {
  return sim == nullptr ? 0 : const_cast<limber_sim*>(sim)->simulation.engine().faults();
}

limber_status limber_hash(limber_sim* sim, uint64_t* hash) {
  if (hash == nullptr) return fail(LIMBER_INVALID_ARGUMENT, "hash is null");
  return with(sim, [&](Simulation& simulation) {
    *hash = simulation.engine().state_hash();
    return LIMBER_OK;
  });
}

limber_status limber_find(limber_sim* sim, const char* address, limber_property** out) {
  if (address == nullptr || out == nullptr) return fail(LIMBER_INVALID_ARGUMENT, "address or out is null");
  *out = nullptr;
  return with(sim, [&](Simulation& simulation) {
    auto found = limber::lib::PropertyHandle::find(simulation.engine(), address);
    if (!found) return fail(LIMBER_NOT_FOUND, found.error());
    simulation.properties().push_back({sim, std::move(*found)});
    *out = &simulation.properties().back();
    return LIMBER_OK;
  });
}

void limber_release(limber_property* property) {
  if (property == nullptr) return;
  (void)with(property->owner, [&](Simulation& simulation) {
    simulation.properties().remove_if([&](const limber_property& one) { return &one == property; });
    return LIMBER_OK;
  });
}

size_t limber_count(const limber_property* property) { return property == nullptr ? 0 : property->handle.count(); }
size_t limber_width(const limber_property* property) { return property == nullptr ? 0 : property->handle.width(); }
const char* limber_address(const limber_property* property, size_t index) {
  if (property == nullptr || index >= property->handle.count()) return nullptr;
  return property->handle.address(index).c_str();
}
const char* limber_unit(const limber_property* property) {
  return property == nullptr ? "" : property->handle.property().unit.c_str();
}
int limber_writable(const limber_property* property) {
  return property != nullptr && property->handle.property().writable() ? 1 : 0;
}
limber_status limber_range(const limber_property* property, size_t number, double* min, double* max) {
  if (property == nullptr || min == nullptr || max == nullptr || number >= property->handle.width())
    return fail(LIMBER_INVALID_ARGUMENT, "a pointer is null, or number is not below the width");
  *min = property->handle.property().low(number);
  *max = property->handle.property().high(number);
  return LIMBER_OK;
}

limber_status limber_read(limber_property* property, double* values, size_t size) {
  return limber::lib::read_values(property, values, size);
}
limber_status limber_read_float(limber_property* property, float* values, size_t size) {
  return limber::lib::read_values(property, values, size);
}
limber_status limber_write(limber_property* property, const double* values, size_t size) {
  return limber::lib::write_values(property, values, size);
}
limber_status limber_write_float(limber_property* property, const float* values, size_t size) {
  return limber::lib::write_values(property, values, size);
}

limber_status limber_send(limber_sim* sim, const char* address, const limber_value* values, size_t count) {
  return with(sim, [&](Simulation& simulation) {
    limber::Result<limber::Message> message = limber::lib::message_of(address, values, count);
    if (!message) return fail(LIMBER_INVALID_ARGUMENT, message.error());
    const limber::Result<void> sent = simulation.send(std::move(*message));
    return sent ? LIMBER_OK : fail(LIMBER_REJECTED, sent.error());
  });
}

limber_status limber_next_event(limber_sim* sim, limber_event* event) {
  if (event == nullptr) return fail(LIMBER_INVALID_ARGUMENT, "event is null");
  return with(sim, [&](Simulation& simulation) {
    return simulation.next_event(*event) ? LIMBER_OK : fail(LIMBER_NONE, "there is no event");
  });
}

limber_status limber_contacts(limber_sim* sim, limber_contact* contacts, size_t capacity, size_t* count) {
  if (count == nullptr || (contacts == nullptr && capacity > 0))
    return fail(LIMBER_INVALID_ARGUMENT, "contacts or count is null");
  return with(sim, [&](Simulation& simulation) {
    *count = simulation.contacts(contacts, capacity);
    return LIMBER_OK;
  });
}

limber_status limber_save(limber_sim* sim, limber_state** out) {
  if (out == nullptr) return fail(LIMBER_INVALID_ARGUMENT, "out is null");
  *out = nullptr;
  return with(sim, [&](Simulation& simulation) {
    auto& states = simulation.states();
    states.push_back({sim, simulation.engine().saved_states().save(states.empty() ? nullptr : &states.back().state)});
    *out = &states.back();
    return LIMBER_OK;
  });
}

limber_status limber_restore(limber_sim* sim, const limber_state* state) {
  if (state == nullptr) return fail(LIMBER_INVALID_ARGUMENT, "the state is null");
  return with(sim, [&](Simulation& simulation) {
    if (state->owner != sim) return fail(LIMBER_INVALID_ARGUMENT, "the state belongs to another simulation");
    const limber::Result<void> restored = simulation.engine().saved_states().restore(state->state);
    return restored ? LIMBER_OK : fail(LIMBER_STALE, restored.error());
  });
}

void limber_discard(limber_state* state) {
  if (state == nullptr) return;
  (void)with(state->owner, [&](Simulation& simulation) {
    simulation.engine().saved_states().discard(state->state);
    simulation.states().remove_if([&](const limber_state& one) { return &one == state; });
    return LIMBER_OK;
  });
}

limber_status limber_render(limber_sim* sim, const limber_image* image, uint8_t* pixels, size_t size) {
  if (image == nullptr || pixels == nullptr) return fail(LIMBER_INVALID_ARGUMENT, "image or pixels is null");
  return with(sim, [&](Simulation& simulation) {
    if (const limber::Result<void> valid = limber::lib::check_image(simulation.engine(), *image, size); !valid)
      return fail(LIMBER_INVALID_ARGUMENT, valid.error());
    const limber::Result<void> drawn = simulation.view().draw(simulation.engine(), *image, pixels);
    return drawn ? LIMBER_OK : fail(LIMBER_NO_GRAPHICS, drawn.error());
  });
}
