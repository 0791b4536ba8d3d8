// A target is identified by host and port.
#include "net/osc/targets/target_edits.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/text.h"

namespace limber::osc {

namespace {

constexpr std::size_t kMaxText = 1024;

bool is_add(const Message& message) { return same_address(message.address, "/osc/target/add"); }
bool is_remove(const Message& message) { return same_address(message.address, "/osc/target/remove"); }

// The arguments as the text of --osc-out.
std::string target_argument(const Message& message) {
  std::string text;
  for (const Arg& arg : message.args) text += (text.empty() ? "" : ",") + arg.text;
  return text;
}

}  // namespace

Result<void> TargetEdits::push(const Message& message, const CommandOrigin& origin) {
  const std::string text = target_argument(message);
  if (text.size() > kMaxText) return Error{fmt::format("the text has more than {} bytes", kMaxText)};
  if (is_add(message) || is_remove(message)) {
    const Result<StreamTarget> target = parse_target(text, {});
    if (!target) return Error{target.error()};
  }
  if (!queue_.push({message, origin})) return Error{"too many requests at once"};
  return {};
}

Result<void> TargetEdits::execute(const Message& message, const std::vector<StreamTarget>& current) {
  if (!is_add(message) && !is_remove(message)) {
    edits_.clear();
    return {};
  }
  Result<StreamTarget> target = parse_target(target_argument(message), current);
  if (!target) return Error{target.error()};
  const bool known =
      std::ranges::any_of(current, [&](const StreamTarget& each) { return same_endpoint(each, *target); });
  if (is_remove(message)) {
    if (!known) {
      return Error{fmt::format("there is no target {}; /list/targets lists them",
                               host_port_text(printable(target->host), target->port))};
    }
    set({std::move(*target), true});
    return {};
  }
  if (!known && current.size() >= kMaxTargets)
    return Error{fmt::format("there are {} targets; remove one with /osc/target/remove", current.size())};
  set({std::move(*target), false});
  return {};
}

void TargetEdits::set(Edit edit) {
  std::erase_if(edits_, [&](const Edit& each) { return same_endpoint(each.target, edit.target); });
  // a removed target that no scene has any more
  if (edits_.size() >= 2 * kMaxTargets) {
    const auto removed = std::ranges::find(edits_, true, &Edit::removed);
    if (removed != edits_.end()) edits_.erase(removed);
  }
  edits_.push_back(std::move(edit));
}

std::vector<StreamTarget> TargetEdits::applied_to(std::vector<StreamTarget> targets) const {
  for (const Edit& edit : edits_) {
    const auto first =
        std::ranges::find_if(targets, [&](const StreamTarget& each) { return same_endpoint(each, edit.target); });
    if (edit.removed) {
      std::erase_if(targets, [&](const StreamTarget& each) { return same_endpoint(each, edit.target); });
    } else if (first != targets.end()) {
      *first = edit.target;
    } else {
      targets.push_back(edit.target);
    }
  }
  return targets;
}

std::string targets_text(const std::vector<StreamTarget>& targets) {
  std::string text;
  for (const StreamTarget& target : targets) text += (text.empty() ? "" : "\n") + target_text(target);
  return text;
}

}  // namespace limber::osc
