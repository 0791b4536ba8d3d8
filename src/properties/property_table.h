// Property tables: the properties (settings, states, readouts and actions) of each class (body, joint, …). OSC, Lua,
// the panel, presets and the reference are derived from these tables. A table is immutable once it is built.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace limber {

enum class PropertyKind : std::uint8_t {
  setting,  ///< Can be set and is saved in scenes and presets. Listings call this kind "property".
  state,    ///< Can be set but is not saved: poses, velocities, `paused`.
  readout,  ///< Read-only, computed by the simulation.
  action,   ///< A command.
};

enum class PropertyType : std::uint8_t {
  number,
  integer,
  boolean,
  choice,  ///< A number with labels.
  vec3,
  flags3,  ///< Three booleans, one per axis.
  quat,    ///< x y z w.
  none,    ///< Actions; `min_args` and `max_args` limit their arguments.
  text,    ///< A readout that is a string; it has no components.
};

/// Returns the number of components of a value of the type.
std::uint32_t width_of(PropertyType type);
std::string_view type_name(PropertyType type);
std::string_view kind_name(PropertyKind kind);

inline constexpr double kUnbounded = std::numeric_limits<double>::infinity();

struct Property;

/// The functions through which a property acts on the simulation object of its node, which is of the class that the
/// table describes. Null: none.
struct PropertyCallbacks {
  void (*on_change)(void* object) = nullptr;  ///< On-change callback: applies new values. Called by Store::flush().
  bool independent =
      false;  ///< The on-change callback uses this object's data only, so several objects may run in parallel.
  void (*read)(const void* object, double* out) = nullptr;      ///< Getter of a computed property; it is not stored.
  void (*write)(void* object, const double* in) = nullptr;      ///< Setter of a computed property.
  std::string_view (*read_text)(const void* object) = nullptr;  ///< Text of a readout; valid until the object changes.
  Result<void> (*validate)(const void* object, const double* in) = nullptr;  ///< Error if the object rejects the value.
  Result<void> (*invoke)(void* object, std::span<const double> args) = nullptr;  ///< Runs an action.
  void (*on_write)(void* object,
                   const Property& property) = nullptr;  ///< Called after every write, even of an equal value.
};

/// Describes one setting, state, readout or action.
struct Property : PropertyCallbacks {
  std::string name;  ///< snake_case; the same in OSC, Lua, the panel and files.
  PropertyType type = PropertyType::number;
  PropertyKind kind = PropertyKind::setting;
  std::string unit;          ///< A symbol of units(), or empty for a dimensionless number.
  double min = -kUnbounded;  ///< Each component is clamped to [min, max].
  double max = kUnbounded;
  std::vector<double> axis_min;  ///< One range per number, if they differ; min and max then enclose all of them.
  std::vector<double> axis_max;
  double step = 0;                   ///< Suggested increment for one notch of a mouse wheel; 0: none.
  std::array<double, 4> initial{};   ///< The default.
  std::string doc;                   ///< A one-line description.
  std::vector<std::string> choices;  ///< Labels of the values 0, 1, 2 … of a choice.
  /// vec3 and flags3 of joints and motors: a single number sets the joint's own axis, a single boolean all axes.
  bool own_axis = false;
  bool euler = false;      ///< vec3: Euler angles of the rotation Rx·Ry·Rz, in degrees; interpolated as a rotation.
  bool transient = false;  ///< Stored in the transient block: changed by the simulation, part of every snapshot.
  bool hashed = false;  ///< Part of the state hash: all stored settings and states, and readouts that are declared so.
  std::uint32_t min_args = 0;  ///< Number of arguments of an action.
  std::uint32_t max_args = 0;

  std::uint32_t index = 0;   ///< Position in the table.
  std::uint32_t offset = 0;  ///< First number in the node's persistent or transient block.
  std::uint32_t width = 0;

  double low(std::size_t i) const { return axis_min.empty() ? min : axis_min[i]; }
  double high(std::size_t i) const { return axis_max.empty() ? max : axis_max[i]; }
  bool computed() const { return read != nullptr; }
  bool stored() const { return kind != PropertyKind::action && !computed(); }
  bool writable() const { return kind == PropertyKind::setting || kind == PropertyKind::state; }
};

/// Returns the range as text: "0 .. 10", or "0 1 2 .. 5 5 5" if each component has its own.
std::string range_text(const Property& property);

/// How one number of a node's block enters the state hash.
struct HashedNumber {
  std::uint64_t key = 0;      ///< Hash of the property's name and the number's index; 0: the number is not hashed.
  std::uint64_t initial = 0;  ///< Bits of the default. A number with these bits adds nothing to the hash.
};

class PropertyTable;
/// Returns a table for properties that are defined at run time (parameters of scenes and behaviors). Equal arguments
/// give the same table. Tables are never freed, because stores refer to them by address. [any]
const PropertyTable& shared_table(std::string name, std::string path, std::vector<Property> properties);

/// The properties of one class, at most 64.
class PropertyTable {
 public:
  /// `path`: the address of its nodes, with <name> for names that the user gives. `legacy_prefix`: the address prefix
  /// of ofxDabPhysics (legacy addresses), or empty. `prefetch`: prefetches the data that an object's on-change
  /// callbacks read.
  PropertyTable(std::string name, std::string path, std::string legacy_prefix, std::vector<Property> properties,
                void (*prefetch)(const void* object) = nullptr);

  const std::string& name() const { return name_; }
  const std::string& path() const { return path_; }
  const std::string& legacy_prefix() const { return legacy_prefix_; }
  std::span<const Property> properties() const { return properties_; }
  const Property& property(std::uint32_t index) const { return properties_[index]; }
  std::uint32_t persistent_width() const { return persistent_width_; }
  std::uint32_t transient_width() const { return transient_width_; }
  /// How each number of a node's persistent block enters the state hash, and each of its transient block.
  std::span<const HashedNumber> hashed_persistent() const { return hashed_persistent_; }
  std::span<const HashedNumber> hashed_transient() const { return hashed_transient_; }
  void prefetch(const void* object) const {
    if (prefetch_ != nullptr) prefetch_(object);
  }

  /// Returns the property of that name (compared as same_name() does), or null.
  const Property* find(std::string_view name) const;
  /// Returns the property of exactly that name, which must exist (checked).
  const Property& at(std::string_view name) const;
  std::vector<std::string_view> property_names() const;

 private:
  std::string name_;
  std::string path_;
  std::string legacy_prefix_;
  std::vector<Property> properties_;
  std::vector<std::string> normalized_names_;
  std::uint32_t persistent_width_ = 0;
  std::uint32_t transient_width_ = 0;
  std::vector<HashedNumber> hashed_persistent_;
  std::vector<HashedNumber> hashed_transient_;
  void (*prefetch_)(const void* object) = nullptr;
};

namespace properties {

// Builders of properties. They nest: transient(readout(vec3("velocity", "m/s", …))).

/// Properties of each type, of kind `setting` (a text is a readout).
Property number(std::string name, std::string unit, double initial, double min, double max, std::string doc);
Property integer(std::string name, double initial, double min, double max, std::string doc);
Property boolean(std::string name, bool initial, std::string doc);
Property choice(std::string name, std::vector<std::string> labels, std::uint32_t initial, std::string doc);
Property vec3(std::string name, std::string unit, std::array<double, 3> initial, double min, double max,
              std::string doc);
Property flags3(std::string name, std::array<bool, 3> initial, std::string doc);
Property quat(std::string name, std::string doc);
Property text(std::string name, std::string doc);
Property action(std::string name, std::uint32_t min_args, std::uint32_t max_args, std::string doc);

// Functions that set one field of a property and return it: `kind` (state, readout), `transient`, `own_axis` (axes),
// `hashed`, `euler` (euler_angles), `independent`.
Property state(Property property);
Property readout(Property property);
Property transient(Property property);
Property axes(Property property);
Property hashed(Property property);
Property euler_angles(Property property);
Property independent(Property property);

/// Wraps a member function of the object's class, or a free function that gets the object first, as a callback of a
/// property.
template <auto Function>
struct Bind;
template <class T, void (T::*Member)()>
struct Bind<Member> {
  static void on_change(void* object) { (static_cast<T*>(object)->*Member)(); }
};
template <class T, void (T::*Member)(double*) const>
struct Bind<Member> {
  static void read(const void* object, double* out) { (static_cast<const T*>(object)->*Member)(out); }
};
template <class T, void (T::*Member)(const double*)>
struct Bind<Member> {
  static void write(void* object, const double* in) { (static_cast<T*>(object)->*Member)(in); }
};
template <class T, std::string_view (T::*Member)() const>
struct Bind<Member> {
  static std::string_view read_text(const void* object) { return (static_cast<const T*>(object)->*Member)(); }
};
template <class T, Result<void> (T::*Member)(const double*) const>
struct Bind<Member> {
  static Result<void> validate(const void* object, const double* in) {
    return (static_cast<const T*>(object)->*Member)(in);
  }
};
template <class T, Result<void> (T::*Member)(std::span<const double>)>
struct Bind<Member> {
  static Result<void> invoke(void* object, std::span<const double> args) {
    return (static_cast<T*>(object)->*Member)(args);
  }
};
template <class T, void (*Function)(T&)>
struct Bind<Function> {
  static void on_change(void* object) { Function(*static_cast<T*>(object)); }
};
template <class T, void (*Function)(const T&, double*)>
struct Bind<Function> {
  static void read(const void* object, double* out) { Function(*static_cast<const T*>(object), out); }
};
template <class T, void (*Function)(T&, const double*)>
struct Bind<Function> {
  static void write(void* object, const double* in) { Function(*static_cast<T*>(object), in); }
};
template <class T, Result<void> (*Function)(const T&, const double*)>
struct Bind<Function> {
  static Result<void> validate(const void* object, const double* in) {
    return Function(*static_cast<const T*>(object), in);
  }
};
template <class T, Result<void> (*Function)(T&, std::span<const double>)>
struct Bind<Function> {
  static Result<void> invoke(void* object, std::span<const double> args) {
    return Function(*static_cast<T*>(object), args);
  }
};

// Functions that set a callback of a property to a member or free function (Bind) and return the property.
template <auto Function>
Property on_change(Property property) {
  property.on_change = &Bind<Function>::on_change;
  return property;
}
template <auto Read, auto Write>
Property computed(Property property) {
  property.read = &Bind<Read>::read;
  property.write = &Bind<Write>::write;
  return property;
}
template <auto Read>
Property computed(Property property) {
  property.read = &Bind<Read>::read;
  return property;
}
template <auto Function>
Property text_from(Property property) {
  property.read_text = &Bind<Function>::read_text;
  return property;
}
template <auto Function>
Property validated_by(Property property) {
  property.validate = &Bind<Function>::validate;
  return property;
}
template <auto Function>
Property invokes(Property property) {
  property.invoke = &Bind<Function>::invoke;
  return property;
}

}  // namespace properties
}  // namespace limber
