// Messages and values set by controllers are read from the link's ring buffers; changes of a pattern are found by
// comparing two value snapshots.
#include "net/console/subscription.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "base/osc_pattern.h"
#include "base/system/clock.h"
#include "base/text.h"
#include "properties/property_text.h"

namespace limber::console {

namespace {

constexpr std::size_t kMaxValues = 200000;  // max. number of values compared for a pattern
constexpr int kMatchWork = 20 * PatternBudget::kStepsPerMessage;
constexpr double kMaxLag = 0.5;  // s that a snapshot may be late

std::string change_text(const std::string& path, const std::string& from, const std::string& to) {
  return from.empty() && to.empty() ? path : fmt::format("{} {} → {}", path, from, to);
}

class MessageSubscription : public Subscription {
 public:
  MessageSubscription(engine::EngineLink& link, std::string pattern)
      : messages_(link.message_log),
        watch_(link.message_log),
        pattern_(std::move(pattern)),
        seen_(messages_.newest()) {}

  void poll(const std::function<void(std::string)>& send, const std::function<void(std::uint64_t)>& drop) override {
    for (const engine::LoggedMessage& line : messages_.since(seen_)) {
      if (const std::uint64_t overwritten = line.number - seen_ - 1; overwritten > 0) drop(overwritten);
      seen_ = line.number;
      if (!pattern_.empty() && !address_matches(pattern_, line.message.address)) continue;
      send(traffic_line(line.incoming, line.time, line.peer, engine::message_text(line.message)));
    }
  }

 private:
  engine::MessageLog& messages_;
  engine::MessageLog::Watch watch_;
  const std::string pattern_;
  std::uint64_t seen_;
};

// values set by controllers, starting with the recent ones
class ControllerSubscription : public Subscription {
 public:
  explicit ControllerSubscription(engine::ChangeLog& changes) : changes_(changes) {}

  void poll(const std::function<void(std::string)>& send, const std::function<void(std::uint64_t)>&) override {
    for (const engine::ChangeEntry& line : changes_.after(seen_)) {
      seen_ = line.version;
      send(change_line(line.time, line.source, change_text(line.path, line.from, line.to)));
    }
  }

 private:
  engine::ChangeLog& changes_;
  std::uint64_t seen_ = 0;
};

// all values that match a pattern, regardless of the source of the change
class PatternSubscription : public Subscription {
 public:
  PatternSubscription(engine::EngineLink& link, std::string pattern) : link_(link), pattern_(std::move(pattern)) {}

  void poll(const std::function<void(std::string)>& send, const std::function<void(std::uint64_t)>&) override {
    const std::shared_ptr<const engine::ValueSnapshot> snapshot = link_.value_snapshots.read();
    const bool is_new = requested_ != 0 && snapshot != nullptr && snapshot->request >= requested_;
    if (is_new) compare(snapshot, send);
    if (is_new || requested_ == 0) requested_ = link_.request_value_snapshot();
  }

 private:
  struct Value {
    TreePropertyRef ref;
    ValueLocation location;
    std::size_t old_index = 0;  // index in the previous tree's values; kNew: was not in that tree
  };
  static constexpr std::size_t kNew = ~std::size_t{0};

  void compare(const std::shared_ptr<const engine::ValueSnapshot>& snapshot,
               const std::function<void(std::string)>& send) {
    const bool tree_changed = snapshot_ == nullptr || snapshot_->tree != snapshot->tree;
    if (tree_changed) bind(*snapshot->tree);
    const double now = system::clock_seconds();
    const std::unordered_map<std::string, std::string> sources = sources_since(compared_at_);
    compared_at_ = now - kMaxLag;
    for (std::size_t i = 0; snapshot_ != nullptr && i < values_.size(); i++) {
      const std::size_t before = tree_changed ? values_[i].old_index : i;
      if (before == kNew) continue;
      const engine::PropertyValue old_value = snapshot_->value((tree_changed ? old_values_ : values_)[before].location);
      const engine::PropertyValue new_value = snapshot->value(values_[i].location);
      const Property& property = *values_[i].ref.property;
      const bool same = old_value.text == new_value.text &&
                        std::equal(new_value.numbers, new_value.numbers + property.width, old_value.numbers);
      if (same) continue;
      const std::string path = snapshot->tree->path(values_[i].ref);
      const auto source = sources.find(path);
      send(change_line(now, source == sources.end() ? "" : source->second,
                       change_text(path, text_of(property, old_value), text_of(property, new_value))));
    }
    snapshot_ = snapshot;
    old_values_.clear();
  }

  // collects the properties to compare and their indices in the previous tree
  void bind(const TreeSnapshot& tree) {
    old_values_ = std::exchange(values_, {});
    PatternBudget work{kMatchWork};
    Result<std::vector<TreePropertyRef>> refs = tree.match(pattern_, work, kMaxValues);
    if (!refs) return;
    std::unordered_map<std::uint64_t, std::size_t> known;
    const auto key = [](const TreeSnapshot& of, const TreePropertyRef& place) {
      return std::uint64_t{of.nodes()[place.node].id.slot} << 32 | place.property->index;
    };
    for (std::size_t i = 0; i < old_values_.size(); i++) known.emplace(key(*snapshot_->tree, old_values_[i].ref), i);
    for (const TreePropertyRef& ref : *refs) {
      if (ref.property == nullptr || ref.property->kind == PropertyKind::action) continue;
      const auto at = known.find(key(tree, ref));
      const bool same_object =
          at != known.end() && old_values_[at->second].ref.property == ref.property &&
          snapshot_->tree->nodes()[old_values_[at->second].ref.node].id == tree.nodes()[ref.node].id;
      values_.push_back({ref, tree.location(ref), same_object ? at->second : kNew});
    }
  }

  static std::string text_of(const Property& property, const engine::PropertyValue& value) {
    return property.type == PropertyType::text ? printable(value.text) : value_text(property, value.numbers);
  }

  // the controller that last set each path since `time`
  std::unordered_map<std::string, std::string> sources_since(double time) const {
    std::unordered_map<std::string, std::string> sources;
    for (engine::ChangeEntry& line : link_.changes.since(time)) sources[line.path] = std::move(line.source);
    return sources;
  }

  engine::EngineLink& link_;
  const std::string pattern_;
  std::uint64_t requested_ = 0;
  double compared_at_ = system::clock_seconds();
  std::shared_ptr<const engine::ValueSnapshot> snapshot_;
  std::vector<Value> values_;
  std::vector<Value> old_values_;  // values of the previous tree, while it is compared with the new one
};

}  // namespace

Result<std::unique_ptr<Subscription>> make_subscription(engine::EngineLink& link, const ConsoleRequest& request) {
  if (!request.text.empty() && request.text.front() != '/')
    return Error{fmt::format("'{}' is not an address; it must begin with /", printable(shortened(request.text, 100)))};
  std::unique_ptr<Subscription> subscription;
  if (request.kind == ConsoleRequest::Kind::traffic) {
    subscription = std::make_unique<MessageSubscription>(link, request.text);
  } else if (request.text.empty()) {
    subscription = std::make_unique<ControllerSubscription>(link.changes);
  } else {
    subscription = std::make_unique<PatternSubscription>(link, request.text);
  }
  return subscription;
}

}  // namespace limber::console
