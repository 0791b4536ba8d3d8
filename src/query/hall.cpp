// Images are asked for, never waited for.
#include "query/hall.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "query/notices.h"

namespace limber {

namespace {

HttpAnswer too_busy(const char* why) { return {503, "text/plain; charset=utf-8", fmt::format("{}\n", why), {}}; }

}  // namespace

Hall::Hall(EngineLink& link, QueryDoors doors, std::vector<std::string> names, double (*now)())
    : link_(link), doors_(std::move(doors)), names_(std::move(names)), now_(now) {}

HostInfo Hall::info() const { return {names_, doors_.osc_port()}; }

void Hall::ask(HttpRequest request, Answer answer) {
  if (std::optional<HttpAnswer> known = answer_at_once(request, info())) return answer(std::move(*known));
  if (waiting_.size() >= kMostWaiting) return answer(too_busy("too many ask at once; ask again"));
  waiting_.push_back({std::move(request), std::move(answer), link_.ask_image(), now_()});
}

void Hall::enter(Client& client) {
  clients_.push_back(&client);
  hurry();
}

void Hall::leave(const Client& client) { std::erase(clients_, &client); }

void Hall::hurry() {
  // one is on its way: those who hurry now get the one after it, however many do
  if (asked_ != 0) return (void)(again_ = true);
  asked_ = link_.ask_image();
  last_ask_ = now_();
}

void Hall::bell() {
  send_answers();
  const std::shared_ptr<const Image> image = link_.images.read();
  if (image == nullptr) return;
  answer_waiting(image);
  if (asked_ == 0 || image->asks < asked_) return;
  asked_ = 0;
  take_image(image);
  if (std::exchange(again_, false)) hurry();
}

void Hall::take_image(const std::shared_ptr<const Image>& image) {
  std::vector<std::string> notices;
  if (image_ != nullptr && image_->tree != image->tree) notices = notices_between(*image_->tree, *image->tree);
  image_ = image;
  // a client may leave while it is told
  for (Client* const client : std::vector<Client*>(clients_)) {
    if (std::find(clients_.begin(), clients_.end(), client) != clients_.end()) client->image(image, notices);
  }
}

void Hall::answer_waiting(const std::shared_ptr<const Image>& image) {
  std::vector<Waiting> due;
  std::erase_if(waiting_, [&](Waiting& w) {
    if (image->asks < w.ask) return false;
    due.push_back(std::move(w));
    return true;
  });
  std::size_t bytes = 0;
  for (const Waiting& w : due) {
    if (bytes > kMostBytes) {
      w.answer(too_busy("too many ask for much at once; ask again"));
      continue;
    }
    HttpAnswer answer = answer_from(w.request, *image);
    bytes += answer.body.size();
    w.answer(std::move(answer));
  }
}

void Hall::beat() {
  const double now = now_();
  const bool listened = std::any_of(clients_.begin(), clients_.end(), [](const Client* c) { return c->listens(); });
  // half a beat of slack: timers are never exact
  const double pause = listened ? kBeat / 2 : kIdleBeat - kBeat / 2;
  if (!clients_.empty() && asked_ == 0 && now - last_ask_ >= pause) hurry();
  for (Client* const client : std::vector<Client*>(clients_)) {
    if (std::find(clients_.begin(), clients_.end(), client) != clients_.end()) client->log();
  }
  // an engine that is busy, or has not begun, must not hold up who asks
  std::vector<Waiting> late;
  std::erase_if(waiting_, [&](Waiting& w) {
    if (now - w.since < kPatience) return false;
    late.push_back(std::move(w));
    return true;
  });
  const std::shared_ptr<const Image> image = link_.images.read();
  for (const Waiting& w : late) {
    w.answer(image != nullptr ? answer_from(w.request, *image) : too_busy("the simulation is busy; ask again"));
  }
}

void Hall::send_answers() {
  link_.query_outbox.drain(answers_);
  for (const Outgoing& out : answers_) {
    const auto to = std::ranges::find_if(clients_, [&](const Client* c) { return c->origin() == out.origin; });
    if (to != clients_.end()) (*to)->answer(out, now_());
  }
}

}  // namespace limber
