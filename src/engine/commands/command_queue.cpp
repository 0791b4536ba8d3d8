// CommandQueue: separates urgent requests from their command.
#include "engine/commands/command_queue.h"

#include <algorithm>

namespace limber::engine {

bool CommandQueue::push(Command command, bool urgent_pushed) {
  if (command.arrival == 0) command.arrival = next_arrival();
  const bool urgent =
      std::ranges::any_of(command.messages, [](const Message& m) { return urgent_kind(m).has_value(); });
  if (urgent) {
    move_urgent(command, urgent_pushed);
    if (command.messages.empty() && command.evaluation == nullptr) return true;
  }
  return waiting_.push(std::move(command));
}

void CommandQueue::move_urgent(Command& command, bool urgent_pushed) {
  std::vector<Message> rest;
  for (Message& message : command.messages) {
    const std::optional<UrgentKind> kind = urgent_kind(message);
    if (!kind) {
      rest.push_back(std::move(message));
      continue;
    }
    discarded_ += std::erase_if(rest, [&](const Message& before) { return UrgentPrecedence::discards(before, *kind); });
    if (urgent_pushed) continue;
    push_urgent({*kind, std::move(message), command.origin, command.arrival});
  }
  command.messages = std::move(rest);
}

void CommandQueue::push_urgent(UrgentRequest request) {
  const std::scoped_lock lock(urgent_mutex_);
  const auto same = [&](const UrgentRequest& other) {
    return other.kind == request.kind && other.origin == request.origin;
  };
  const auto same_kind = [&](const UrgentRequest& other) { return other.kind == request.kind; };
  auto older = std::ranges::find_if(urgent_, same);
  if (older == urgent_.end() && urgent_.size() >= kMaxUrgent) older = std::ranges::find_if(urgent_, same_kind);
  // the queue is full of other kinds, so one of them has more than one request
  if (older == urgent_.end() && urgent_.size() >= kMaxUrgent) {
    older = std::ranges::find_if(urgent_, [&](const UrgentRequest& candidate) {
      return std::ranges::count(urgent_, candidate.kind, &UrgentRequest::kind) > 1;
    });
  }
  if (older != urgent_.end()) urgent_.erase(older);
  urgent_.push_back(std::move(request));
  urgent_count_.store(urgent_.size(), std::memory_order_relaxed);
}

void CommandQueue::drain_urgent(std::vector<UrgentRequest>& out) {
  out.clear();
  if (urgent_count_.load(std::memory_order_relaxed) == 0) return;
  const std::scoped_lock lock(urgent_mutex_);
  urgent_.swap(out);
  urgent_count_.store(0, std::memory_order_relaxed);
}

bool CommandQueue::has_urgent(UrgentKind kind) {
  if (urgent_count_.load(std::memory_order_relaxed) == 0) return false;
  const std::scoped_lock lock(urgent_mutex_);
  return std::ranges::any_of(urgent_, [&](const UrgentRequest& request) { return request.kind == kind; });
}

}  // namespace limber::engine
