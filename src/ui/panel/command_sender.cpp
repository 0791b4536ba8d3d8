// Commands, requests and replies of the panel.
#include "ui/panel/command_sender.h"

namespace limber::panel {

namespace {
constexpr double kSnapshotInterval = 1.0 / 20;  // s; the simulation spends at most 1 % of its time on value snapshots
}

std::uint64_t CommandSender::send(Message message, double now) {
  engine::Command command;
  command.messages.push_back(std::move(message));
  command.origin = CommandOrigin{CommandSource::panel, 0, edit_number_, false};
  link_.command_queue.push(std::move(command));
  request(now);
  return last_request_;
}

void CommandSender::request(double now) {
  last_request_ = link_.request_value_snapshot();
  last_request_time_ = now;
}

void CommandSender::update_request(const engine::ValueSnapshot* latest, double now) {
  const bool waiting = latest == nullptr || latest->request < last_request_;
  if (last_request_ == 0 || (!waiting && now - last_request_time_ >= kSnapshotInterval)) request(now);
}

std::span<const engine::Outgoing> CommandSender::replies() {
  link_.panel_output_queue.drain(replies_);
  return replies_;
}

}  // namespace limber::panel
