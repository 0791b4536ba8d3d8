// Feed: computes the change notifications of one subscriber (OSC or OSCQuery): the current value of each subscribed
// path that differs from the value last sent to the client or set by it. A value that several paths match is sent once.
// [one thread]
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "engine/output/value_snapshot.h"
#include "properties/pattern_budget.h"

namespace limber::engine {

class Feed {
 public:
  static constexpr std::size_t kMaxPaths = 4096;   ///< Maximum number of subscribed paths and patterns.
  static constexpr std::size_t kMaxValues = 4096;  ///< Maximum number of values that they match.
  static constexpr int kSliceWork = 200'000;       ///< Matching steps per slice, some nanoseconds each.

  /// Sends a value. Returns false if it does not fit; it is then offered again the next time.
  using Sender = std::function<bool(const std::string& path, const Property& property, const PropertyValue& value)>;

  /// Subscribes to a path or a pattern, which may match nothing until objects are added. If several paths match a
  /// value, it belongs to the one with the smallest `order`. A repeated subscription to a path (not a pattern) sends
  /// its value again. Returns false if there are too many.
  bool add(std::string_view path, std::int64_t order = 0);
  /// Cancels a subscription and forgets the values sent for it. Returns false if there is none.
  bool remove(std::string_view path);
  bool empty() const { return paths_.empty(); }
  std::size_t size() const { return paths_.size(); }

  /// Sets the current snapshot: resolves paths if the tree has changed, and notes the values that `self` has set since
  /// the previous snapshot. Call it for every snapshot.
  void update(const std::shared_ptr<const ValueSnapshot>& snapshot, const CommandOrigin& self);
  /// Like update(), but does at most kSliceWork per call. Returns false if it must be called again; nothing can be sent
  /// until it returns true.
  bool update_some(const std::shared_ptr<const ValueSnapshot>& snapshot, const CommandOrigin& self);
  /// Sends the values of the current snapshot that have changed. A value that does not fit is the first the next time.
  void send_changes(const Sender& send);
  /// Sends the changed values of one path. Returns the number of values that it matches, and false if one did not fit.
  std::pair<std::size_t, bool> send_changes(std::string_view path, const Sender& send);
  /// Returns the reason why a path matches no value in the current snapshot; empty if it does or is not subscribed.
  std::string_view problem(std::string_view path) const;
  /// True if the paths match more than kMaxValues values; the others are not sent.
  bool truncated() const { return truncated_; }

 private:
  struct Value {
    std::string path;
    const Property* property = nullptr;
    ValueLocation numbers;
    std::uint64_t key = 0;   // key of node and property
    bool sent = false;       // the client knows this value
    bool own_write = false;  // the client has set the value since the last notification
    std::array<double, 4> sent_value{};
    std::string sent_text;
    std::array<double, 4> own_value{};
  };

  struct Path {
    std::string text;
    std::int64_t order = 0;
    std::size_t first = 0, end = 0;  // range of its values in values_
    std::size_t next = 0;            // the value of this range to send first
    std::string problem;
  };

  void begin_resolve(const std::shared_ptr<const TreeSnapshot>& tree);
  bool resolve_some();
  void resolve(Path& path);
  void add_value(const TreePropertyRef& ref);
  void note_own_write(const ClientWrite& write);
  bool send_value(Value& value, const Sender& send);
  bool send_changes(std::size_t first, std::size_t end, std::size_t& next, const Sender& send);

  std::vector<Path> paths_;                                  // sorted by order
  std::vector<Value> values_;                                // grouped by path
  std::unordered_map<std::uint64_t, std::uint32_t> by_key_;  // index in values_ by Value::key
  bool unresolved_ = true;                                   // paths_ has changed since values_ was built
  bool truncated_ = false;
  std::shared_ptr<const ValueSnapshot> snapshot_;
  std::uint64_t last_write_ = 0;
  std::size_t next_value_ = 0;
  // state of a resolution in progress
  std::shared_ptr<const TreeSnapshot> tree_;  // null: none in progress
  std::size_t next_path_ = 0;                 // index in paths_
  PatternBudget resolve_budget_;
  std::vector<Value> old_values_;
  std::unordered_map<std::string_view, Value*> old_by_path_;
};

}  // namespace limber::engine
