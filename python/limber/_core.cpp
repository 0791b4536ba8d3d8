// The extension module limber._core: the functions of limber.h as Python classes. Errors become exceptions, and arrays
// share the memory of NumPy arrays.
#include <limber.h>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace py = pybind11;

namespace {

struct SimError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Raises the exception of a status. Messages of the library name place, problem and fix.
void check(limber_status status) {
  switch (status) {
    case LIMBER_OK:
      return;
    case LIMBER_INVALID_ARGUMENT:
      throw py::value_error(limber_last_error());
    case LIMBER_NOT_FOUND:
      throw py::key_error(limber_last_error());
    case LIMBER_REJECTED:
      throw py::value_error(limber_last_error());
    case LIMBER_NO_MEMORY:
      throw std::bad_alloc();
    default:
      throw SimError(limber_last_error());
  }
}

// Only the main interpreter: the state of LuaJIT and of this module belongs to the process.
void reject_subinterpreter() {
  if (PyInterpreterState_Get() != PyInterpreterState_Main())
    throw py::import_error("limber can't be used in subinterpreters; use processes (limber.VectorEnv) or threads");
}

class Sim;

// A state that its simulation has saved.
class State {
 public:
  State(std::shared_ptr<limber_sim> sim, limber_state* state) : sim_(std::move(sim)), state_(state) {}
  ~State() { limber_discard(state_); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  const limber_state* get() const { return state_; }

 private:
  std::shared_ptr<limber_sim> sim_;  // outlives its states
  limber_state* state_;
};

class Property {
 public:
  Property(std::shared_ptr<limber_sim> sim, const std::string& address) : sim_(std::move(sim)) {
    check(limber_find(sim_.get(), address.c_str(), &property_));
    const auto count = static_cast<py::ssize_t>(limber_count(property_));
    const auto width = static_cast<py::ssize_t>(limber_width(property_));
    values_ = width == 1 ? py::array_t<double>(count) : py::array_t<double>({count, width});
    read();
  }
  ~Property() { limber_release(property_); }
  Property(const Property&) = delete;
  Property& operator=(const Property&) = delete;

  const py::array_t<double>& values() const { return values_; }
  const py::array_t<double>& read() {
    check(limber_read(property_, values_.mutable_data(), static_cast<std::size_t>(values_.size())));
    return values_;
  }
  void write(const py::object& values) {
    if (values.is(values_)) return write_own();
    // a copy only if the type, the order or the shape differs
    using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;
    const Array array = Array::ensure(values);
    if (!array)  // ensure() drops the error of NumPy
      throw py::value_error("the values of a property are numbers, not " + std::string(py::str(py::type::of(values))));
    if (array.ndim() == 0) {
      std::fill_n(values_.mutable_data(), values_.size(), *array.data());
      return write_own();
    }
    check(limber_write(property_, array.data(), static_cast<std::size_t>(array.size())));
  }
  std::vector<std::string> addresses() const {
    std::vector<std::string> list;
    for (std::size_t i = 0; i < limber_count(property_); i++) list.emplace_back(limber_address(property_, i));
    return list;
  }
  std::string unit() const { return limber_unit(property_); }
  bool writable() const { return limber_writable(property_) != 0; }
  std::pair<double, double> range(std::size_t number) const {
    std::pair<double, double> range;
    check(limber_range(property_, number, &range.first, &range.second));
    return range;
  }

 private:
  void write_own() { check(limber_write(property_, values_.data(), static_cast<std::size_t>(values_.size()))); }

  std::shared_ptr<limber_sim> sim_;
  limber_property* property_ = nullptr;
  py::array_t<double> values_;
};

limber_value value_of(const py::handle& object, std::vector<std::string>& texts) {
  if (object.is_none()) return {LIMBER_NIL, 0, nullptr};
  if (py::isinstance<py::bool_>(object)) return {LIMBER_BOOLEAN, object.cast<bool>() ? 1.0 : 0.0, nullptr};
  if (py::isinstance<py::str>(object)) {
    texts.push_back(object.cast<std::string>());
    return {LIMBER_TEXT, 0, texts.back().c_str()};
  }
  return {LIMBER_NUMBER, object.cast<double>(), nullptr};
}

// A text as str. Scripts may print and send bytes that are not UTF-8, which are replaced.
py::str text_of(const char* text) {
  return py::reinterpret_steal<py::str>(
      PyUnicode_DecodeUTF8(text, static_cast<Py_ssize_t>(std::strlen(text)), "replace"));
}

py::object object_of(const limber_value& value) {
  switch (value.kind) {
    case LIMBER_NUMBER:
      return py::float_(value.number);
    case LIMBER_BOOLEAN:
      return py::bool_(value.number != 0);
    case LIMBER_TEXT:
      return text_of(value.text);
    default:
      return py::none();
  }
}

using Point = std::array<double, 3>;

limber_quality quality_of(const std::string& name) {
  if (name == "high") return LIMBER_QUALITY_HIGH;
  if (name == "medium") return LIMBER_QUALITY_MEDIUM;
  if (name == "low") return LIMBER_QUALITY_LOW;
  throw py::value_error("quality must be 'high', 'medium' or 'low', got '" + name + "'");
}

class Sim {
 public:
  Sim(const std::optional<std::string>& file, const std::optional<std::string>& text, std::optional<std::uint64_t> seed,
      const std::optional<std::string>& data, int threads, py::object log)
      : log_(std::make_shared<py::object>(std::move(log))) {
    limber_options options = LIMBER_OPTIONS;
    if (file) options.file = file->c_str();
    if (text) options.text = text->c_str();
    if (data) options.data = data->c_str();
    if (seed) options.seed = &*seed;
    options.threads = threads;
    if (!log_->is_none()) {
      options.log = &Sim::log_line;
      options.log_context = log_.get();
    }
    limber_sim* created = nullptr;
    limber_status status = LIMBER_OK;
    {
      const py::gil_scoped_release release;
      status = limber_create(&options, &created);
    }
    check(status);
    // the log function outlives the simulation, which may log until its end
    sim_ = std::shared_ptr<limber_sim>(created, [log_function = log_](limber_sim* sim) {
      const py::gil_scoped_release release;
      limber_destroy(sim);
    });
  }

  // Long runs are divided into slices, after which Python handles signals such as Ctrl+C.
  void step(std::uint64_t ticks) {
    std::uint64_t slice = 1;
    for (std::uint64_t left = ticks; left > 0;) {
      limber_status status = LIMBER_OK;
      {
        const py::gil_scoped_release release;
        const auto begin = std::chrono::steady_clock::now();
        do {
          slice = std::min(slice, left);
          status = limber_step(sim_.get(), slice);
          left -= slice;
          if (slice < kMaxSlice) slice *= 2;
        } while (status == LIMBER_OK && left > 0 && std::chrono::steady_clock::now() - begin < kSignalInterval);
        if (left > 0) slice = 1;
      }
      check(status);
      if (left > 0 && PyErr_CheckSignals() != 0) throw py::error_already_set();
    }
  }
  void reset(std::optional<std::uint64_t> seed) {
    limber_status status = LIMBER_OK;
    {
      const py::gil_scoped_release release;
      status = limber_reset(sim_.get(), seed ? &*seed : nullptr);
    }
    check(status);
  }
  std::uint64_t hash() const {
    std::uint64_t hash = 0;
    check(limber_hash(sim_.get(), &hash));
    return hash;
  }
  std::unique_ptr<Property> property(const std::string& address) const {
    return std::make_unique<Property>(sim_, address);
  }
  std::unique_ptr<State> state() const {
    limber_state* state = nullptr;
    check(limber_save(sim_.get(), &state));
    return std::make_unique<State>(sim_, state);
  }
  void restore(const State& state) const { check(limber_restore(sim_.get(), state.get())); }
  void send(const std::string& address, const py::args& arguments) const {
    std::vector<std::string> texts;
    texts.reserve(arguments.size());
    std::vector<limber_value> values;
    for (const py::handle& argument : arguments) values.push_back(value_of(argument, texts));
    limber_status status = LIMBER_OK;
    {
      const py::gil_scoped_release release;
      status = limber_send(sim_.get(), address.c_str(), values.data(), values.size());
    }
    check(status);
  }
  py::list events() const {
    py::list list;
    limber_event event{};
    for (limber_status status = LIMBER_OK; (status = limber_next_event(sim_.get(), &event)) != LIMBER_NONE;) {
      check(status);
      py::tuple arguments(event.count);
      for (std::size_t i = 0; i < event.count; i++) arguments[i] = object_of(event.values[i]);
      list.append(py::make_tuple(text_of(event.address), arguments));
    }
    return list;
  }
  py::list contacts() const {
    std::size_t count = 0;
    check(limber_contacts(sim_.get(), nullptr, 0, &count));
    std::vector<limber_contact> contacts(count);
    check(limber_contacts(sim_.get(), contacts.data(), contacts.size(), &count));
    py::list list;
    const auto vector = [](const double* v) { return py::make_tuple(v[0], v[1], v[2]); };
    for (const limber_contact& c : contacts) {
      py::dict contact;
      contact["a"] = py::make_tuple(c.body_a, c.part_a);
      contact["b"] = py::make_tuple(c.body_b, c.part_b);
      contact["position"] = vector(c.position);
      contact["normal"] = vector(c.normal);
      contact["impulse"] = c.impulse;
      contact["friction"] = vector(c.friction);
      contact["distance"] = c.distance;
      list.append(contact);
    }
    return list;
  }
  py::array_t<std::uint8_t> render(int width, int height, const std::optional<Point>& position,
                                   const std::optional<Point>& target, double fovy, const std::string& quality) const {
    limber_image image = LIMBER_IMAGE;
    image.width = width;
    image.height = height;
    if (position) image.position = position->data();
    if (target) image.target = target->data();
    image.fovy = fovy;
    image.quality = quality_of(quality);
    if (width < 1 || height < 1) throw py::value_error("width and height must be at least 1");
    py::array_t<std::uint8_t> pixels({height, width, 3});
    std::uint8_t* const data = pixels.mutable_data();
    const auto size = static_cast<std::size_t>(pixels.size());
    limber_status status = LIMBER_OK;
    {
      const py::gil_scoped_release release;
      status = limber_render(sim_.get(), &image, data, size);
    }
    check(status);
    return pixels;
  }
  std::uint64_t tick() const { return limber_tick(sim_.get()); }
  double time() const { return limber_time(sim_.get()); }
  double timestep() const { return limber_timestep(sim_.get()); }
  std::uint64_t faults() const { return limber_faults(sim_.get()); }

 private:
  static constexpr std::chrono::milliseconds kSignalInterval{20};
  static constexpr std::uint64_t kMaxSlice = 64;  // ticks between two readings of the clock

  // An exception of the function can't pass through the library, so Python reports it as ignored; Ctrl+C is raised
  // again after the call.
  static void log_line(void* context, limber_log_level level, const char* text) {
    const py::gil_scoped_acquire acquire;
    try {
      static constexpr const char* kLevels[] = {"info", "warning", "error", "print"};
      (*static_cast<py::object*>(context))(kLevels[level], text_of(text));
    } catch (py::error_already_set& error) {
      if (error.matches(PyExc_KeyboardInterrupt)) return PyErr_SetInterrupt();
      error.discard_as_unraisable("limber: the log function");
    }
  }

  std::shared_ptr<py::object> log_;
  std::shared_ptr<limber_sim> sim_;
};

}  // namespace

PYBIND11_MODULE(_core, module) {
  reject_subinterpreter();
  module.doc() = "The classes of the package limber that are written in C++.";
  module.attr("version") = limber_version(nullptr, nullptr);
  module.def(
      "data_folder", &limber_data_folder,
      "The folder with Limber's scripts/ and urdf/, such as data_folder() + '/scripts/arms.lua'; '' if there is none.");
  py::register_exception<SimError>(module, "SimError", PyExc_RuntimeError).doc() =
      "The scene has an error, or an object doesn't belong to this simulation, process or run of the scene.";
  py::class_<State>(module, "State", "A state that Sim.state() has saved; Sim.restore() returns to it.");
  py::class_<Property>(module, "Property",
                       "A property of one or more objects as a NumPy array: one number each, or rows of 3 or 4.")
      .def_property_readonly("values", &Property::values,
                             "The array that read() fills: float64, always the same object. Change it and call write() "
                             "to set the values.")
      .def("read", &Property::read, "Reads the present values into `values` and returns it; copies no array.")
      .def("write", &Property::write, py::arg("values"),
           "Sets the values (an array of the same size, or one number for all), clamped to their ranges, from the next "
           "tick on. They don't survive a reset. Raises ValueError if one isn't finite or the property is read-only.")
      .def("range", &Property::range, py::arg("number") = 0, "The range (min, max) of a number of each object.")
      .def_property_readonly("addresses", &Property::addresses, "The address of each object's property.")
      .def_property_readonly("unit", &Property::unit, "The unit's symbol; '' for a number without unit.")
      .def_property_readonly("writable", &Property::writable, "True if the property can be set.");
  py::class_<Sim>(module, "Sim")
      .def(py::init<const std::optional<std::string>&, const std::optional<std::string>&, std::optional<std::uint64_t>,
                    const std::optional<std::string>&, int, py::object>())
      .def("step", &Sim::step, py::arg("ticks") = 1,
           "Advances time by this number of ticks. Other Python threads run meanwhile. Ctrl+C and other signals end it "
           "between two ticks, after which it can be continued.")
      .def("reset", &Sim::reset, py::arg("seed") = py::none(),
           "Runs the scene from its start, with this seed (0 to 2^53) or the same as before. Properties remain valid, "
           "states don't.")
      .def("hash", &Sim::hash, "The hash of the state, equal to that of `limber --hash`.")
      .def("property", &Sim::property, py::arg("address"),
           "Finds a property by its address, or those of several objects by an OSC pattern. Raises KeyError.")
      .def("state", &Sim::state, "Saves the whole state in memory.")
      .def("restore", &Sim::restore, py::arg("state"), "Returns to a saved state.")
      .def("send", &Sim::send, py::arg("address"),
           "Sends an OSC message, which is executed at once. Raises ValueError if it is rejected.")
      .def("events", &Sim::events,
           "Returns and removes the messages from the simulation, as (address, arguments): answers, osc:send, "
           "contacts.")
      .def("contacts", &Sim::contacts, "The contact points of the last tick, of parts with report_contacts.")
      .def("render", &Sim::render, py::arg("width") = 640, py::arg("height") = 480, py::kw_only(),
           py::arg("position") = py::none(), py::arg("target") = py::none(), py::arg("fovy") = 0,
           py::arg("quality") = "high",
           "Draws the present state without a display and returns it as an array (height, width, 3) of uint8: red, "
           "green, blue. position, target: of the camera, world, m; fovy: its field of view, degrees; without them, "
           "those of the scene's camera. quality: 'high', 'medium' or 'low'. Raises SimError where OpenGL is missing.")
      .def_property_readonly("tick", &Sim::tick, "Number of ticks since the start.")
      .def_property_readonly("time", &Sim::time, "Simulated time, s.")
      .def_property_readonly("timestep", &Sim::timestep, "Length of a tick, s.")
      .def_property_readonly("faults", &Sim::faults,
                             "Number of script errors, rejected values and unstable bodies so far.");
}
