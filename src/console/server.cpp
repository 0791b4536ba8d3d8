// One loop, one poll, as the network's.
#include "console/server.h"

#include <cerrno>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/build_info.h"
#include "base/log.h"
#include "base/system/file.h"
#include "base/system/local_socket.h"
#include "base/system/process.h"
#include "base/system/thread.h"
#include "base/system/wait.h"
#include "console/runtime_folder.h"

namespace limber {

namespace {

constexpr auto kLookAtLog = std::chrono::milliseconds(50);  // between two looks at the log while a console listens

}  // namespace

ConsoleServer::ConsoleServer(EngineLink& link, ConsoleOptions options) : link_(link), options_(std::move(options)) {}

ConsoleServer::~ConsoleServer() { stop(); }

Result<void> ConsoleServer::start() {
  if (thread_.joinable()) return {};
  const Result<std::string> folder = options_.folder.empty() ? make_runtime_folder() : options_.folder;
  if (!folder) return Error{folder.error()};
  console_sockets(*folder);  // the look at them removes the dead ones
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
  mail_->wake.notify();
  thread_.join();
  system::remove_file(path_);
  path_.clear();
  listener_ = system::Descriptor();
  visitors_.clear();
}

void ConsoleServer::run() {
  system::name_this_thread("limber-console");
  while (!stop_.load()) {
    wait_for_something();
    mail_->wake.clear();
    let_in();
    hand_out_answers();
    for (auto& [number, visitor] : visitors_) {
      visitor.receive([this, number = number](const ConsoleRequest& request) { return ask(number, request); },
                      [this](const ConsoleRequest& request) { return make_watcher(link_, request); });
      visitor.tell_log();
      visitor.tell_watched();
      visitor.send();
    }
    std::erase_if(visitors_, [](const auto& each) { return each.second.gone(); });
  }
  // what was answered before the end still goes out
  hand_out_answers();
  for (auto& [number, visitor] : visitors_) visitor.send();
}

void ConsoleServer::wait_for_something() {
  std::vector<system::Waiting> waiting = {{.fd = mail_->wake.fd()}, {.fd = rests_ ? -1 : listener_.fd()}};
  for (const auto& [number, visitor] : visitors_) waiting.push_back(visitor.waits_for());
  std::optional<std::chrono::nanoseconds> limit;
  if (!visitors_.empty() || rests_) limit = kLookAtLog;
  // interrupted or not: the loop looks at everything anyway
  (void)system::wait_ready(waiting, limit);
  rests_ = false;
}

void ConsoleServer::let_in() {
  const long user = options_.user < 0 ? system::user_id() : options_.user;
  for (std::size_t i = 0; i < 2 * kMostVisitors; i++) {
    system::Descriptor connection = system::accept_connection(listener_.fd());
    if (!connection.open()) {
      rests_ = errno != EAGAIN && errno != EINTR && errno != ECONNABORTED;
      return;
    }
    if (system::peer_user(connection) != user) {
      log_warning("console: a program of another user was turned away");
      continue;
    }
    Visitor visitor(std::move(connection), log_newest());
    if (visitors_.size() >= kMostVisitors) {
      visitor.say(refused_line(fmt::format("{} consoles are open already; close one", kMostVisitors)));
      visitor.send();
      continue;
    }
    visitor.say(hello_line(version(), system::process_id(), options_.scene));
    visitors_.emplace(++last_visitor_, std::move(visitor));
  }
}

void ConsoleServer::hand_out_answers() {
  mail_->answers.drain(answers_);
  for (const Mail::Answer& answer : answers_) {
    const auto at = visitors_.find(answer.visitor);
    if (at != visitors_.end()) at->second.answer(answer.id, answer.said);
  }
}

std::string ConsoleServer::ask(std::uint64_t visitor, const ConsoleRequest& request) {
  auto wish = std::make_shared<Evaluate>();
  const bool completes = request.wish == ConsoleRequest::Wish::complete;
  wish->wish = completes ? Evaluate::Wish::complete : Evaluate::Wish::run;
  wish->text = request.text;
  wish->answer = [mail = mail_, visitor, id = request.id](Evaluation said) {
    mail->answers.push({visitor, id, std::move(said)});
    mail->wake.notify();
  };
  Command command;
  command.origin.hand = Hand::console;
  command.evaluate = std::move(wish);
  if (!link_.inbox.push(std::move(command))) return "too much is waiting for the scene; try again";
  link_.wake_engine();
  return {};
}

}  // namespace limber
