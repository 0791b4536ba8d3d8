// Traffic and what hands set are read from the link's rings; changes of a pattern are what two images differ in.
#include "console/watcher.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "base/address.h"
#include "base/system/clock.h"
#include "base/text.h"
#include "params/row_text.h"

namespace limber {

namespace {

constexpr std::size_t kMostPlaces = 200000;  // values of a pattern that are compared
constexpr int kWork = 20 * PatternBudget::kMessage;
constexpr double kLate = 0.5;  // s that an image may be behind

std::string change_text(const std::string& path, const std::string& from, const std::string& to) {
  return from.empty() && to.empty() ? path : fmt::format("{} {} → {}", path, from, to);
}

class TrafficWatcher : public Watcher {
 public:
  TrafficWatcher(EngineLink& link, std::string pattern)
      : traffic_(link.traffic), watch_(link.traffic), pattern_(std::move(pattern)), seen_(traffic_.newest()) {}

  void tell(const std::function<void(std::string)>& say, const std::function<void(std::uint64_t)>& miss) override {
    for (const TrafficLine& line : traffic_.since(seen_)) {
      if (const std::uint64_t gone = line.number - seen_ - 1; gone > 0) miss(gone);
      seen_ = line.number;
      if (!pattern_.empty() && !address_matches(pattern_, line.message.address)) continue;
      say(traffic_line(line.in, line.time, line.end, message_text(line.message)));
    }
  }

 private:
  Traffic& traffic_;
  Traffic::Watch watch_;
  const std::string pattern_;
  std::uint64_t seen_;
};

// what hands set, beginning with what they have set lately
class HandWatcher : public Watcher {
 public:
  explicit HandWatcher(ChangeLog& changes) : changes_(changes) {}

  void tell(const std::function<void(std::string)>& say, const std::function<void(std::uint64_t)>&) override {
    for (const ChangeLine& line : changes_.after(seen_)) {
      seen_ = line.version;
      say(change_line(line.time, line.who, change_text(line.path, line.from, line.to)));
    }
  }

 private:
  ChangeLog& changes_;
  std::uint64_t seen_ = 0;
};

// whatever becomes another value of what a pattern reaches, whoever sets it
class ChangeWatcher : public Watcher {
 public:
  ChangeWatcher(EngineLink& link, std::string pattern) : link_(link), pattern_(std::move(pattern)) {}

  void tell(const std::function<void(std::string)>& say, const std::function<void(std::uint64_t)>&) override {
    const std::shared_ptr<const Image> image = link_.images.read();
    const bool fresh = asked_ != 0 && image != nullptr && image->asks >= asked_;
    if (fresh) hear(image, say);
    if (fresh || asked_ == 0) asked_ = link_.ask_image();
  }

 private:
  struct Value {
    TreePlace place;
    TreeNumbers numbers;
    std::size_t before = 0;  // in the values of the tree before; kNew: it was not there
  };
  static constexpr std::size_t kNew = ~std::size_t{0};

  void hear(const std::shared_ptr<const Image>& image, const std::function<void(std::string)>& say) {
    const bool other = image_ == nullptr || image_->tree != image->tree;
    if (other) bind(*image->tree);
    const double now = system::clock_seconds();
    const std::unordered_map<std::string, std::string> hands = hands_since(heard_);
    heard_ = now - kLate;
    for (std::size_t i = 0; image_ != nullptr && i < values_.size(); i++) {
      const std::size_t before = other ? values_[i].before : i;
      if (before == kNew) continue;
      const RowValue was = image_->value((other ? old_ : values_)[before].numbers);
      const RowValue is = image->value(values_[i].numbers);
      const Row& row = *values_[i].place.row;
      const bool same = was.text == is.text && std::equal(is.numbers, is.numbers + row.width, was.numbers);
      if (same) continue;
      const std::string path = image->tree->path(values_[i].place);
      const auto who = hands.find(path);
      say(change_line(now, who == hands.end() ? "" : who->second,
                      change_text(path, text_of(row, was), text_of(row, is))));
    }
    image_ = image;
    old_.clear();
  }

  // the rows that are compared, and which of the tree before each was
  void bind(const Tree& tree) {
    old_ = std::exchange(values_, {});
    PatternBudget work{kWork};
    Result<std::vector<TreePlace>> places = tree.match(pattern_, work, kMostPlaces);
    if (!places) return;
    std::unordered_map<std::uint64_t, std::size_t> known;
    const auto key = [](const Tree& of, const TreePlace& place) {
      return std::uint64_t{of.nodes()[place.node].id.slot} << 32 | place.row->index;
    };
    for (std::size_t i = 0; i < old_.size(); i++) known.emplace(key(*image_->tree, old_[i].place), i);
    for (const TreePlace& place : *places) {
      if (place.row == nullptr || place.row->kind == RowKind::action) continue;
      const auto at = known.find(key(tree, place));
      const bool same_thing = at != known.end() && old_[at->second].place.row == place.row &&
                              image_->tree->nodes()[old_[at->second].place.node].id == tree.nodes()[place.node].id;
      values_.push_back({place, tree.numbers(place), same_thing ? at->second : kNew});
    }
  }

  static std::string text_of(const Row& row, const RowValue& value) {
    return row.type == RowType::text ? printable(value.text) : value_text(row, value.numbers);
  }

  // who set each path since then, of hands
  std::unordered_map<std::string, std::string> hands_since(double time) const {
    std::unordered_map<std::string, std::string> who;
    for (ChangeLine& line : link_.changes.since(time)) who[line.path] = std::move(line.who);
    return who;
  }

  EngineLink& link_;
  const std::string pattern_;
  std::uint64_t asked_ = 0;
  double heard_ = system::clock_seconds();
  std::shared_ptr<const Image> image_;
  std::vector<Value> values_;
  std::vector<Value> old_;  // of the tree before, while another one is compared with it
};

}  // namespace

Result<std::unique_ptr<Watcher>> make_watcher(EngineLink& link, const ConsoleRequest& request) {
  if (!request.text.empty() && request.text.front() != '/')
    return Error{fmt::format("'{}' is no address: it must begin with /", printable(shortened(request.text, 100)))};
  std::unique_ptr<Watcher> watcher;
  if (request.wish == ConsoleRequest::Wish::traffic) {
    watcher = std::make_unique<TrafficWatcher>(link, request.text);
  } else if (request.text.empty()) {
    watcher = std::make_unique<HandWatcher>(link.changes);
  } else {
    watcher = std::make_unique<ChangeWatcher>(link, request.text);
  }
  return watcher;
}

}  // namespace limber
