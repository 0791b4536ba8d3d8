// Layout and numbers of the messages of templates.
#include "net/osc/templates/template_frame.h"

#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "base/text.h"
#include "net/osc/packets/wire.h"
#include "properties/path_matcher.h"

namespace limber::osc {

namespace {

constexpr std::size_t kAutomaticBundle = 1472;  // payload of an Ethernet frame
constexpr std::size_t kMaxObjects = 65536;      // of a template
constexpr std::size_t kMaxProblems = 8;

void append_padded(std::string& out, std::string_view text) {
  out += text;
  out.append(padded(text.size()) - text.size(), '\0');
}

void append_u32(std::string& out, std::uint32_t value) {
  out.append(4, '\0');
  store_u32(out.data() + out.size() - 4, value);
}

// The parts of a value such as "-position.y".
struct TemplateValue {
  explicit TemplateValue(std::string_view value) : negative(value.starts_with('-')) {
    if (negative) value.remove_prefix(1);
    const std::size_t dot = value.find('.');
    property = value.substr(0, dot);
    if (dot != std::string_view::npos) component = value.substr(dot + 1);
  }

  bool negative;
  std::string_view property;
  std::optional<std::string_view> component;
};

bool is_text(std::string_view value) { return value.find('{') != std::string_view::npos; }

// Index of a component's name, or none.
std::optional<std::uint32_t> component_named(std::string_view name, std::uint32_t width) {
  constexpr std::string_view kNames = "xyzw";
  const std::size_t at = name.size() == 1 ? kNames.find(name) : std::string_view::npos;
  if (at == std::string_view::npos || at >= width || width == 1) return {};
  return static_cast<std::uint32_t>(at);
}

}  // namespace

void TemplateFrame::problem(std::string text) {
  if (problems_.size() >= kMaxProblems || std::ranges::find(problems_, text) != problems_.end()) return;
  problems_.push_back(std::move(text));
}

void TemplateFrame::lay_out(const std::shared_ptr<const TreeSnapshot>& tree, const StreamTarget& config) {
  if (tree == tree_ && config == config_) return;
  tree_ = tree;
  config_ = config;
  bytes_.clear();
  datagrams_.clear();
  numbers_.clear();
  problems_.clear();
  begin_ = 0;
  if (tree == nullptr) return;
  for (const StreamMessage& wanted : config.messages) add_template(wanted);
  end_datagram();
}

// The objects that the pattern matches, in the order of the tree: those with the first property; if there is none, the
// first object, so that its class is reported.
Result<std::vector<std::uint32_t>> TemplateFrame::objects_of(const StreamMessage& wanted) const {
  if (!is_address_pattern(wanted.objects)) {
    const Result<TreePropertyRef> ref = tree_->find(wanted.objects);
    if (!ref) return Error{ref.error()};
    if (ref->property != nullptr) return Error{fmt::format("'{}' is a property, not an object", wanted.objects)};
    return std::vector{ref->node};
  }
  const auto first = std::ranges::find_if_not(wanted.values, is_text);
  const std::string property = first == wanted.values.end() ? "*" : std::string(TemplateValue(*first).property);
  PatternBudget budget;
  std::vector<std::uint32_t> objects;
  for (const auto& [name, limit] : {std::pair(property, kMaxObjects), {std::string("*"), std::size_t{1}}}) {
    const Result<std::vector<TreePropertyRef>> refs = tree_->match(wanted.objects + "/" + name, budget, limit);
    if (!refs) return Error{refs.error()};
    for (const TreePropertyRef& ref : *refs) {
      if (objects.empty() || objects.back() != ref.node) objects.push_back(ref.node);
    }
    if (!objects.empty()) return objects;
  }
  return Error{fmt::format("no object matches '{}'", printable(wanted.objects))};
}

void TemplateFrame::add_template(const StreamMessage& wanted) {
  const Result<std::vector<std::uint32_t>> found = objects_of(wanted);
  if (!found) return problem(fmt::format("{}: {}", wanted.address, found.error()));
  Draft draft;
  std::uint32_t body = 0;
  std::size_t index = 0;
  bool any = false;
  for (const std::uint32_t node : *found) {
    const std::uint32_t owner = body_of(node);
    const bool continues = any && owner == body && owner != 0;
    index = continues ? index + 1 : 1;
    if (!(wanted.per_body && continues)) {
      if (any) append(draft);
      draft = {expand(wanted.address, node, index, true), ",", "", {}};
    }
    body = owner;
    any = true;
    if (!add_values(wanted, node, index, draft)) return;
  }
  append(draft);
}

// Appends the arguments of one object. Returns false if it lacks a property.
bool TemplateFrame::add_values(const StreamMessage& wanted, std::uint32_t node, std::size_t index, Draft& draft) {
  for (const std::string& value : wanted.values) {
    if (!is_text(value)) {
      if (!add_value(value, wanted.scale, node, draft)) return false;
      continue;
    }
    draft.tags += 's';
    append_padded(draft.arguments, expand(value, node, index, false));
  }
  return true;
}

bool TemplateFrame::add_value(const std::string& value, double scale, std::uint32_t node, Draft& draft) {
  const TemplateValue parts(value);
  const PropertyTable& table = *tree_->nodes()[node].table;
  const Property* const property = table.find(parts.property);
  const auto reject = [&](const std::string& why) {
    problem(fmt::format("{} of {}: {}", value, tree_->path(node), why));
    return false;
  };
  if (property == nullptr)
    return reject(fmt::format("there is no '{}'{}", parts.property, name_hint(parts.property, table.property_names())));
  if (property->width == 0) return reject("it has no number");
  std::uint32_t first = 0;
  std::uint32_t count = property->width;
  if (parts.component) {
    const std::optional<std::uint32_t> one = component_named(*parts.component, property->width);
    if (!one) return reject(fmt::format("there is no component '{}'", *parts.component));
    first = *one;
    count = 1;
  }
  const auto factor = static_cast<float>(parts.negative ? -scale : scale);
  for (std::uint32_t i = 0; i < count; i++) {
    draft.numbers.push_back(
        {static_cast<std::uint32_t>(draft.arguments.size()), tree_->location({node, property}), first + i, factor});
    draft.tags += 'f';
    draft.arguments.append(4, '\0');
  }
  return true;
}

// The node of the body that a node belongs to; 0: none.
std::uint32_t TemplateFrame::body_of(std::uint32_t node) const {
  for (std::uint32_t at = node; at != 0; at = tree_->nodes()[at].parent) {
    const std::uint32_t parent = tree_->nodes()[at].parent;
    if (parent != 0 && tree_->name(parent) == "body" && tree_->path(parent) == "/physics/body") return at;
  }
  return 0;
}

// Replaces {name}, {body} and {index}.
std::string TemplateFrame::expand(std::string_view text, std::uint32_t node, std::size_t index, bool escaped) const {
  std::string out;
  const auto name_of = [&](std::uint32_t of) {
    const std::string name(of == 0 ? std::string_view() : tree_->name(of));
    return escaped ? escape_name(name) : name;
  };
  while (!text.empty()) {
    const std::size_t open = text.find('{');
    const std::size_t close = text.find('}', open == std::string_view::npos ? 0 : open);
    out += text.substr(0, open);
    if (open == std::string_view::npos || close == std::string_view::npos) break;
    const std::string_view key = text.substr(open + 1, close - open - 1);
    if (key == "name") out += name_of(node);
    if (key == "body") out += name_of(body_of(node));
    if (key == "index") out += std::to_string(index);
    text.remove_prefix(close + 1);
  }
  return out;
}

// Adds a message to the open datagram, or to a new one if it is full.
void TemplateFrame::append(const Draft& draft) {
  std::string message;
  append_padded(message, draft.address);
  append_padded(message, draft.tags);
  const std::size_t head = message.size();
  message += draft.arguments;
  const bool bundles = config_.bundle != 0;
  const std::size_t limit = config_.bundle < 0 ? kAutomaticBundle : static_cast<std::size_t>(config_.bundle);
  if (kBundleHeader + 4 + message.size() > kMaxPacketSize)
    return problem(fmt::format("{}: the message is too large for a datagram", draft.address));
  if (!bundles || bytes_.size() - begin_ + 4 + message.size() > limit) end_datagram();
  std::string out;
  if (bundles && bytes_.size() == begin_) {
    append_padded(out, "#bundle");
    out.append(kBundleHeader - out.size(), '\0');
    out[15] = 1;  // time tag: immediately
  }
  if (bundles) append_u32(out, static_cast<std::uint32_t>(message.size()));
  const std::size_t base = bytes_.size() + out.size() + head;
  for (Number number : draft.numbers) {
    number.position += static_cast<std::uint32_t>(base);
    numbers_.push_back(number);
  }
  out += message;
  bytes_.insert(bytes_.end(), out.begin(), out.end());
}

void TemplateFrame::end_datagram() {
  if (bytes_.size() == begin_) return;
  datagrams_.push_back(static_cast<std::uint32_t>(bytes_.size() - begin_));
  begin_ = bytes_.size();
}

void TemplateFrame::fill(const engine::ValueSnapshot& snapshot) {
  for (const Number& number : numbers_) {
    const double* const values = snapshot.value(number.location).numbers;
    // adding 0 turns -0 into 0
    const float value = values == nullptr ? 0 : static_cast<float>(values[number.component]) * number.factor + 0.0F;
    store_u32(bytes_.data() + number.position, std::bit_cast<std::uint32_t>(value));
  }
}

}  // namespace limber::osc
