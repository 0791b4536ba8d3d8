// Tables: what can be set, read or done on a class of things, one row each. Everything else (OSC, Lua, panel, presets,
// reference) is derived from these rows. Built once, never changed.
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

enum class RowKind : std::uint8_t {
  property,  ///< A value that may be set and kept.
  state,     ///< May be set, but belongs to the moment: poses, velocities, `paused`.
  readout,   ///< A value that the simulation tells.
  action,    ///< Something to do.
};

enum class RowType : std::uint8_t {
  number,
  integer,
  boolean,
  choice,  ///< A number with labels.
  vec3,
  flags3,  ///< Three booleans, one an axis.
  quat,    ///< x y z w.
  none,    ///< Actions: what they take stands in `min_args`, `max_args`.
  text,    ///< What a thing says: a readout without numbers.
};

/// How many numbers a value of the type has.
std::uint32_t width_of(RowType type);
std::string_view type_name(RowType type);
std::string_view kind_name(RowKind kind);

inline constexpr double kUnbounded = std::numeric_limits<double>::infinity();

/// One row. `thing` below is the object that the node stands for, as its class knows it.
struct Row {
  std::string name;  ///< snake_case, the same word everywhere.
  RowType type = RowType::number;
  RowKind kind = RowKind::property;
  std::string unit;          ///< As in units(); empty: a pure number.
  double min = -kUnbounded;  ///< Each number is clamped to min .. max.
  double max = kUnbounded;
  std::vector<double> axis_min;  ///< Where each number has a range of its own: one a number; min, max are the widest.
  std::vector<double> axis_max;
  double step = 0;                   ///< What a turn of a wheel changes it by; 0: nothing is said.
  std::array<double, 4> initial{};   ///< The default.
  std::string doc;                   ///< One line for a person.
  std::vector<std::string> choices;  ///< Labels of a choice: 0, 1, 2 …
  bool own_axis = false;  ///< vec3 and flags3 of joints and motors: one number means the own axis (booleans: all).
  bool turns = false;     ///< vec3: the turn Rx·Ry·Rz, degrees. Between two of them lies a rotation.
  bool live = false;      ///< Stored in the live block: changes by itself, part of every snapshot.
  bool hashed = false;  ///< Part of the state hash: every stored property and state is, a readout where it is declared.

  void (*effect)(void* thing) = nullptr;  ///< Brings a changed value into the world; once, before the next step.
  bool apart = false;  ///< The effect touches what is this thing's alone: of many things they may run side by side.
  void (*read)(const void* thing, double* out) = nullptr;                 ///< A view: computed when asked, not stored.
  void (*write)(void* thing, const double* in) = nullptr;                 ///< A view's way to the rows behind it.
  std::string_view (*say)(const void* thing) = nullptr;                   ///< A text's words, until the thing changes.
  Result<void> (*refuse)(const void* thing, const double* in) = nullptr;  ///< Why this thing can't take this value.
  Result<void> (*act)(void* thing, std::span<const double> args) = nullptr;
  void (*written)(void* thing, const Row& row) = nullptr;  ///< Told at once of each write, even of the same value.
  std::uint32_t min_args = 0;                              ///< Numbers that an action takes.
  std::uint32_t max_args = 0;

  std::uint32_t index = 0;   ///< Position in the table.
  std::uint32_t offset = 0;  ///< First number in the node's kept or live block.
  std::uint32_t width = 0;

  double low(std::size_t i) const { return axis_min.empty() ? min : axis_min[i]; }
  double high(std::size_t i) const { return axis_max.empty() ? max : axis_max[i]; }
  bool view() const { return read != nullptr; }
  bool stored() const { return kind != RowKind::action && !view(); }
  bool writable() const { return kind == RowKind::property || kind == RowKind::state; }
};

/// "0 .. 10", or with ranges of their own "0 1 2 .. 5 5 5".
std::string range_text(const Row& row);

/// A number of a node's block as the state hash sees it.
struct HashedNumber {
  std::uint64_t key = 0;  ///< Of the row's name and the number's place in the row, not of the row's place in the table.
  std::uint64_t initial =
      0;  ///< Bits of the default. A number that has them adds nothing, nor does one whose key is 0.
};

class Table;
/// A table for rows that are known only while the program runs (a scene's parameters, a behaviour's). It lives as long
/// as the program, since stores keep tables by address; an equal one is used again. [any]
const Table& shared_table(std::string name, std::string path, std::vector<Row> rows);

/// The rows of one class.
class Table {
 public:
  /// `path`: where its nodes stand, with <name> for the user's names; `seed`: the seed's address prefix, or empty.
  /// `fetch`: has the processor fetch what the effects of a thing will look at, for who goes through many.
  Table(std::string name, std::string path, std::string seed, std::vector<Row> rows,
        void (*fetch)(const void* thing) = nullptr);

  const std::string& name() const { return name_; }
  const std::string& path() const { return path_; }
  const std::string& seed() const { return seed_; }
  std::span<const Row> rows() const { return rows_; }
  const Row& row(std::uint32_t index) const { return rows_[index]; }
  std::uint32_t kept_width() const { return kept_width_; }
  std::uint32_t live_width() const { return live_width_; }
  /// For each number of the kept block, or of the live block.
  std::span<const HashedNumber> hashed_kept() const { return hashed_kept_; }
  std::span<const HashedNumber> hashed_live() const { return hashed_live_; }
  void fetch(const void* thing) const {
    if (fetch_ != nullptr) fetch_(thing);
  }

  /// The row of that name, compared by the one naming rule; null when there is none.
  const Row* find(std::string_view name) const;
  /// The row of exactly that name; it is a fault of ours when there is none.
  const Row& at(std::string_view name) const;
  std::vector<std::string_view> row_names() const;

 private:
  std::string name_;
  std::string path_;
  std::string seed_;
  std::vector<Row> rows_;
  std::vector<std::string> plain_;
  std::uint32_t kept_width_ = 0;
  std::uint32_t live_width_ = 0;
  std::vector<HashedNumber> hashed_kept_;
  std::vector<HashedNumber> hashed_live_;
  void (*fetch_)(const void* thing) = nullptr;
};

namespace rows {

/// Starting points of rows; designated changes follow: `with(number("mass", "kg", 1), …)`.
Row number(std::string name, std::string unit, double initial, double min, double max, std::string doc);
Row integer(std::string name, double initial, double min, double max, std::string doc);
Row boolean(std::string name, bool initial, std::string doc);
Row choice(std::string name, std::vector<std::string> labels, std::uint32_t initial, std::string doc);
Row vec3(std::string name, std::string unit, std::array<double, 3> initial, double min, double max, std::string doc);
Row flags3(std::string name, std::array<bool, 3> initial, std::string doc);
Row quat(std::string name, std::string doc);
Row text(std::string name, std::string doc);
Row action(std::string name, std::uint32_t min_args, std::uint32_t max_args, std::string doc);

/// The row as a state, a readout, a live one, one of three axes with an own axis.
Row state(Row row);
Row readout(Row row);
Row live(Row row);
Row axes(Row row);
/// A readout as part of the state hash.
Row hashed(Row row);
/// The three numbers as a turn.
Row turns(Row row);
/// Its effect as one that many things may have side by side.
Row apart(Row row);

/// A member function of T as effect, view or action of a row.
template <auto Member>
struct Bind;
template <class T, void (T::*Member)()>
struct Bind<Member> {
  static void effect(void* thing) { (static_cast<T*>(thing)->*Member)(); }
};
template <class T, void (T::*Member)(double*) const>
struct Bind<Member> {
  static void read(const void* thing, double* out) { (static_cast<const T*>(thing)->*Member)(out); }
};
template <class T, void (T::*Member)(const double*)>
struct Bind<Member> {
  static void write(void* thing, const double* in) { (static_cast<T*>(thing)->*Member)(in); }
};
template <class T, std::string_view (T::*Member)() const>
struct Bind<Member> {
  static std::string_view say(const void* thing) { return (static_cast<const T*>(thing)->*Member)(); }
};
template <class T, Result<void> (T::*Member)(const double*) const>
struct Bind<Member> {
  static Result<void> refuse(const void* thing, const double* in) {
    return (static_cast<const T*>(thing)->*Member)(in);
  }
};
template <class T, Result<void> (T::*Member)(std::span<const double>)>
struct Bind<Member> {
  static Result<void> act(void* thing, std::span<const double> args) { return (static_cast<T*>(thing)->*Member)(args); }
};

template <auto Member>
Row effect(Row row) {
  row.effect = &Bind<Member>::effect;
  return row;
}
template <auto Read, auto Write>
Row view(Row row) {
  row.read = &Bind<Read>::read;
  row.write = &Bind<Write>::write;
  return row;
}
template <auto Read>
Row view(Row row) {
  row.read = &Bind<Read>::read;
  return row;
}
template <auto Member>
Row say(Row row) {
  row.say = &Bind<Member>::say;
  return row;
}
template <auto Member>
Row refuse(Row row) {
  row.refuse = &Bind<Member>::refuse;
  return row;
}
template <auto Member>
Row act(Row row) {
  row.act = &Bind<Member>::act;
  return row;
}

}  // namespace rows
}  // namespace limber
