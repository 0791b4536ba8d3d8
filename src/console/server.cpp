// One loop, one poll, as the network's.
#include "console/server.h"

#include <poll.h>
#include <pthread.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/build_info.h"
#include "base/log.h"
#include "console/runtime_folder.h"

namespace limber {

namespace {

constexpr int kLookAtLog = 50;  // ms between two looks at the log while somebody listens

}  // namespace

ConsoleServer::ConsoleServer(EngineLink& link, ConsoleOptions options) : link_(link), options_(std::move(options)) {}

ConsoleServer::~ConsoleServer() { stop(); }

Result<void> ConsoleServer::start() {
  if (thread_.joinable()) return {};
  const Result<std::string> folder = options_.folder.empty() ? make_runtime_folder() : options_.folder;
  if (!folder) return Error{folder.error()};
  console_sockets(*folder);  // the look at them removes the dead ones
  std::string path = socket_path(*folder, getpid());
  Result<Descriptor> listener = listen_console(path);
  if (!listener) return Error{listener.error()};
  listener_ = std::move(*listener);
  path_ = std::move(path);
  stop_ = false;
  thread_ = std::thread([this] { run(); });
  pthread_setname_np(thread_.native_handle(), "limber-console");
  return {};
}

void ConsoleServer::stop() {
  if (!thread_.joinable()) return;
  stop_ = true;
  mail_->wake.ring();
  thread_.join();
  unlink(path_.c_str());
  path_.clear();
  listener_ = Descriptor();
  visitors_.clear();
}

void ConsoleServer::run() {
  while (!stop_.load()) {
    wait_for_something();
    mail_->wake.answer();
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
  // a negative descriptor is passed over: one that waits for its answer must not wake us by hanging up
  std::vector<pollfd> polled = {{mail_->wake.fd(), POLLIN, 0}, {rests_ ? -1 : listener_.fd(), POLLIN, 0}};
  for (const auto& [number, visitor] : visitors_) {
    const short events = visitor.events();
    polled.push_back({events == 0 ? -1 : visitor.fd(), events, 0});
  }
  // interrupted or not: the loop looks at everything anyway
  poll(polled.data(), polled.size(), visitors_.empty() && !rests_ ? -1 : kLookAtLog);
  rests_ = false;
}

void ConsoleServer::let_in() {
  const long user = options_.user < 0 ? static_cast<long>(geteuid()) : options_.user;
  for (std::size_t i = 0; i < 2 * kMostVisitors; i++) {
    Descriptor connection(accept4(listener_.fd(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
    if (!connection.open()) {
      rests_ = errno != EAGAIN && errno != EINTR && errno != ECONNABORTED;
      return;
    }
    if (peer_user(connection) != user) {
      log_warning("console: a program of another user was turned away");
      continue;
    }
    Visitor visitor(std::move(connection), log_newest());
    if (visitors_.size() >= kMostVisitors) {
      visitor.say(refused_line(fmt::format("{} consoles are open already; close one", kMostVisitors)));
      visitor.send();
      continue;
    }
    visitor.say(hello_line(version(), getpid(), options_.scene));
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
    mail->wake.ring();
  };
  Command command;
  command.origin.hand = Hand::console;
  command.evaluate = std::move(wish);
  if (!link_.inbox.push(std::move(command))) return "too much is waiting for the scene; try again";
  link_.wake_engine();
  return {};
}

}  // namespace limber
