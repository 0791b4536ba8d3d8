// SceneRandom: the random generator of a scene's file. [sim]
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "base/hash.h"
#include "base/memory/archive.h"
#include "base/random.h"

namespace limber::script {

/// Seeded with the world's seed and the name of the file.
class SceneRandom {
 public:
  void set_name(std::string name) { name_ = std::move(name); }
  /// Returns the generator and seeds it on first use. At the top level, a changed seed seeds it again; a change in a
  /// callback takes effect at the next start.
  Random& generator(std::uint64_t seed, bool top_level) {
    if (!seeded_with_ || (top_level && *seeded_with_ != seed)) {
      seeded_with_ = seed;
      random_ = Random(seed, name_);
    }
    return random_;
  }

  /// Saves the state for rollback().
  void begin_call() {
    random_before_ = random_;
    seeded_before_ = seeded_with_;
  }
  /// Undoes the draws since begin_call().
  void rollback() {
    random_ = random_before_;
    seeded_with_ = seeded_before_;
  }

  /// Adds the state to a hash, if the generator was used.
  void add_to(NumberHash& numbers) const {
    if (random_.used()) numbers.add(random_.state());
  }
  void serialize(Archive& archive) { archive.serialize_all(random_, seeded_with_); }

 private:
  std::string name_;
  std::optional<std::uint64_t> seeded_with_;
  Random random_;
  std::optional<std::uint64_t> seeded_before_;
  Random random_before_;
};

}  // namespace limber::script
