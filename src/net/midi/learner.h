// Learner: finds the control that is moved after /midi/learn. [one thread]
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "net/midi/map.h"

namespace limber::midi {

/// A request to learn the control of an address.
struct LearnRequest {
  std::string address;
  int component = 0;
  std::optional<ControlMode> mode;
};

class Learner {
 public:
  static constexpr std::int64_t kSettleTime = 150'000'000;  ///< ns from the first movement to the decision.

  /// Begins to learn; replaces an earlier request.
  void begin(LearnRequest request);
  void cancel() { request_.reset(); }
  const std::optional<LearnRequest>& request() const { return request_; }
  /// A control has moved. The halves of a 14-bit value and the messages of a parameter count as one control.
  void accept(std::string_view port, const ControlEvent& event, std::int64_t now);
  /// Time of the decision, ns; nothing: no control has moved.
  std::optional<std::int64_t> due() const;
  /// Returns the entry for the control, once it is decided, and ends learning.
  std::optional<MidiEntry> finish(std::int64_t now);

 private:
  std::optional<LearnRequest> request_;
  std::string port_;
  std::optional<ControlEvent> control_;
  std::int64_t first_ = 0;  // time of the first movement, ns
};

}  // namespace limber::midi
