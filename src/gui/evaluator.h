// Evaluator: texts for the running scene, the way of `limber console`: asked here, answered by the simulation between
// two ticks, heard a frame later.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/inbox.h"
#include "engine/link.h"

namespace limber {

class Evaluator {
 public:
  struct Answer {
    std::uint64_t id = 0;
    Evaluation said;
  };

  /// Its number; 0: the simulation takes no more just now.
  std::uint64_t ask(EngineLink& link, std::string text, Evaluate::Wish wish = Evaluate::Wish::run);
  /// What has been answered since the last call.
  const std::vector<Answer>& answers();

 private:
  static constexpr std::size_t kMostWaiting = 256;
  // shared with what the simulation holds, which may answer after this has gone
  std::shared_ptr<Inbox<Answer>> inbox_ = std::make_shared<Inbox<Answer>>(kMostWaiting);
  std::vector<Answer> heard_;
  std::uint64_t asked_ = 0;
};

}  // namespace limber
