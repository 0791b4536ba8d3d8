// One thread that polls the listening socket, all connections and the result queue.
#include "net/console/server.h"

#include <cerrno>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/build_info.h"
#include "base/log/log.h"
#include "base/system/file.h"
#include "base/system/net/local_socket.h"
#include "base/system/process.h"
#include "base/system/thread.h"
#include "base/system/wait.h"
#include "net/console/runtime_folder.h"

namespace limber::console {

namespace {

constexpr auto kLogPollInterval = std::chrono::milliseconds(50);  // log polling interval while a console is connected

}  // namespace

ConsoleServer::ConsoleServer(engine::EngineLink& link, ConsoleOptions options)
    : link_(link), options_(std::move(options)) {}

ConsoleServer::~ConsoleServer() { stop(); }

Result<void> ConsoleServer::start() {
  if (thread_.joinable()) return {};
  const Result<std::string> folder = options_.folder.empty() ? make_runtime_folder() : options_.folder;
  if (!folder) return Error{folder.error()};
  console_sockets(*folder);  // also removes sockets of programs that have exited
  std::string path = socket_path(*folder, system::process_id());
  Result<system::Descriptor> listener = system::listen_local(path);
  if (!listener) return Error{listener.error()};
  listener_ = std::move(*listener);
  path_ = std::move(path);
  stop_ = false;
  thread_ = std::thread([this] { run(); });
  return {};
}

void ConsoleServer::stop() {
  if (!thread_.joinable()) return;
  stop_ = true;
  result_queue_->wake.notify();
  thread_.join();
  system::remove_file(path_);
  path_.clear();
  listener_ = system::Descriptor();
  connections_.clear();
}

void ConsoleServer::run() {
  system::name_this_thread("limber-console");
  while (!stop_.load()) {
    wait_for_events();
    result_queue_->wake.clear();
    accept_connections();
    deliver_results();
    for (auto& [number, connection] : connections_) {
      connection.receive([this, number = number](const ConsoleRequest& request) { return submit(number, request); },
                         [this](const ConsoleRequest& request) { return make_subscription(link_, request); });
      connection.send_log();
      connection.send_subscribed();
      connection.send();
    }
    std::erase_if(connections_, [](const auto& each) { return each.second.finished(); });
  }
  // send the results that arrived before stop()
  deliver_results();
  for (auto& [number, connection] : connections_) connection.send();
}

void ConsoleServer::wait_for_events() {
  std::vector<system::PollEntry> waiting = {{.fd = result_queue_->wake.fd()},
                                            {.fd = accept_paused_ ? -1 : listener_.fd()}};
  for (const auto& [number, connection] : connections_) waiting.push_back(connection.poll_entry());
  std::optional<std::chrono::nanoseconds> limit;
  if (!connections_.empty() || accept_paused_) limit = kLogPollInterval;
  // no need to check the result: the loop checks every source after each wake-up
  (void)system::wait_ready(waiting, limit);
  accept_paused_ = false;
}

void ConsoleServer::accept_connections() {
  const long user = options_.allowed_user < 0 ? system::user_id() : options_.allowed_user;
  for (std::size_t i = 0; i < 2 * kMaxConnections; i++) {
    system::Descriptor connection = system::accept_connection(listener_.fd());
    if (!connection.is_open()) {
      accept_paused_ = errno != EAGAIN && errno != EINTR && errno != ECONNABORTED;
      return;
    }
    if (system::peer_user(connection) != user) {
      log_warning("console: rejected a program of another user");
      continue;
    }
    ConsoleConnection client(std::move(connection), log_newest());
    if (connections_.size() >= kMaxConnections) {
      client.append(rejected_line(fmt::format("{} consoles are open already; close one", kMaxConnections)));
      client.send();
      continue;
    }
    client.append(hello_line(version(), system::process_id(), options_.scene));
    connections_.emplace(++last_connection_, std::move(client));
  }
}

void ConsoleServer::deliver_results() {
  result_queue_->results.drain(results_);
  for (const ResultQueue::Entry& result : results_) {
    const auto at = connections_.find(result.connection);
    if (at != connections_.end()) at->second.finish_request(result.id, result.evaluation);
  }
}

std::string ConsoleServer::submit(std::uint64_t connection, const ConsoleRequest& request) {
  auto job = std::make_shared<engine::EvaluationRequest>();
  const bool completes = request.kind == ConsoleRequest::Kind::complete;
  job->action = completes ? engine::EvaluationRequest::Action::complete : engine::EvaluationRequest::Action::run;
  job->text = request.text;
  job->on_result = [queue = result_queue_, connection, id = request.id](Evaluation evaluation) {
    queue->results.push({connection, id, std::move(evaluation)});
    queue->wake.notify();
  };
  engine::Command command;
  command.origin.source = CommandSource::console;
  command.evaluation = std::move(job);
  if (!link_.command_queue.push(std::move(command))) return "the command queue is full; try again";
  link_.wake_engine();
  return {};
}

}  // namespace limber::console
