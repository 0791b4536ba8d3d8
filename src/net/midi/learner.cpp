// Learner: the most specific interpretation of a movement wins.
#include "net/midi/learner.h"

#include <utility>

namespace limber::midi {

namespace {

constexpr int kFirstChannelMode = 120;

// Order of interpretations; 0: none.
int rank_of(const ControlEvent& event) {
  switch (event.kind) {
    case ControlKind::nrpn:
    case ControlKind::rpn:
      return 4;
    case ControlKind::cc14:
      return 0;  // reported for each control change below 32: the fine half shows a pair
    case ControlKind::cc:
      return event.number < kFirstChannelMode ? 2 : 0;
    case ControlKind::note:
      return event.value > 0 ? 2 : 0;
    case ControlKind::key_pressure:
    case ControlKind::pressure:
      return 1;  // keys with aftertouch send it all the time
    default:
      return 2;
  }
}

bool is_pair(const ControlEvent& coarse, const ControlEvent& fine) {
  return coarse.kind == ControlKind::cc && fine.kind == ControlKind::cc && coarse.channel == fine.channel &&
         coarse.number < 32 && fine.number == coarse.number + 32;
}

}  // namespace

void Learner::begin(LearnRequest request) {
  request_ = std::move(request);
  control_.reset();
}

void Learner::accept(std::string_view port, const ControlEvent& event, std::int64_t now) {
  const int rank = rank_of(event);
  if (!request_ || rank == 0 || (control_ && port != port_)) return;
  if (!control_) {
    first_ = now;
    port_ = port;
    control_ = event;
  } else if (is_pair(*control_, event)) {
    control_ = ControlEvent{ControlKind::cc14, control_->channel, control_->number, 0};
  } else if (rank > rank_of(*control_) && control_->kind != ControlKind::cc14) {
    control_ = event;
  } else if (rank == 4) {
    control_ = event;  // data entry is a control change, and a pair, as well
  }
}

std::optional<std::int64_t> Learner::due() const {
  if (!request_ || !control_) return std::nullopt;
  return first_ + kSettleTime;
}

std::optional<MidiEntry> Learner::finish(std::int64_t now) {
  const std::optional<std::int64_t> time = due();
  if (!time || now < *time) return std::nullopt;
  MidiEntry entry;
  entry.port = port_;
  entry.channel = control_->channel;
  entry.kind = control_->kind;
  entry.number = control_->number;
  entry.address = request_->address;
  entry.component = request_->component;
  entry.mode = request_->mode;
  request_.reset();
  return entry;
}

}  // namespace limber::midi
