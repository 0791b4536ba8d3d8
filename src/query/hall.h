// Hall: where requests wait for an image and clients are told of changes. Knows the engine's link, no sockets. [query]
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/system/clock.h"
#include "engine/link.h"
#include "query/client.h"
#include "query/request.h"

namespace limber {

class Hall {
 public:
  static constexpr double kBeat = 1.0 / 30;  ///< s; how often those who listen are told.
  static constexpr double kIdleBeat = 0.2;   ///< s; how often others hear of what came and went.
  static constexpr double kPatience = 1;     ///< s; how long a request waits for an image.
  static constexpr std::size_t kMostWaiting = 256;
  static constexpr std::size_t kMostBytes = std::size_t{64} << 20;  ///< Of answers from one image, about.

  using Answer = std::function<void(HttpAnswer answer)>;

  /// `now` reads a clock in seconds. `link` outlives it.
  Hall(EngineLink& link, QueryDoors doors, std::vector<std::string> names, double (*now)() = &system::clock_seconds);

  const QueryDoors& doors() const { return doors_; }
  HostInfo info() const;
  /// Answers at once, or in bell() or beat().
  void ask(HttpRequest request, Answer answer);

  void enter(Client& client);
  void leave(const Client& client);
  /// The client waits for its first values: an image soon.
  void hurry();

  /// Something may have come by the link: an image, answers.
  void bell();
  /// To be called every kBeat while busy().
  void beat();
  /// Lets go of all who wait, unanswered: what their answers hold (a connection, say) goes now.
  void dismiss() { waiting_.clear(); }
  /// Whether anybody waits or may be told something.
  bool busy() const { return !waiting_.empty() || !clients_.empty(); }

 private:
  struct Waiting {
    HttpRequest request;
    Answer answer;
    std::uint64_t ask = 0;
    double since = 0;
  };

  void take_image(const std::shared_ptr<const Image>& image);
  void answer_waiting(const std::shared_ptr<const Image>& image);
  void send_answers();

  EngineLink& link_;
  const QueryDoors doors_;
  const std::vector<std::string> names_;
  double (*now_)();
  std::vector<Waiting> waiting_;
  std::vector<Client*> clients_;
  std::shared_ptr<const Image> image_;  // heard last by the clients
  std::uint64_t asked_ = 0;             // for the clients; 0: nothing is on its way
  bool again_ = false;                  // and another one after it
  double last_ask_ = 0;                 // s
  std::vector<Outgoing> answers_;
};

}  // namespace limber
