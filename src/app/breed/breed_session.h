// BreedSession: the variations of `limber breed`, with their processes and presets. It carries out the user's actions
// and is independent of the window. [main]
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "app/breed/variation_process.h"
#include "app/experiments/parameter_presets.h"
#include "experiments/breeding.h"
#include "ui/panel/breed/breed_gui.h"

namespace limber::app {

class BreedSession {
 public:
  static constexpr std::size_t kCount = experiments::Breeding::kCount;

  struct Options {
    experiments::WorkerSetup setup;    ///< Its parameters are the axes of `breeding`.
    std::uint64_t seed = 1;            ///< Of all variations.
    std::vector<std::string> command;  ///< The program of a variation, and its arguments.
    PresetStore presets;
  };

  BreedSession(Options options, experiments::Breeding breeding);

  void perform(const panel::BreedAction& action);
  /// Requests images of this size, unless they are on their way. `mouse`: moves all cameras. `now` in s.
  void request_images(int width, int height, const MouseMovement& mouse, double now);
  /// Reads answers until `seconds` have passed, and returns which variations have a new image.
  std::array<bool, kCount> read_images(double seconds);

  const render::Pixels& image(std::size_t variation) const { return processes_[variation].image(); }
  /// True if a variation has failed before its first image.
  bool failed(std::size_t variation) const { return processes_[variation].failed(); }
  /// Returns the content of the window, without textures.
  const panel::BreedView& view();

 private:
  // An individual that was stored as a preset.
  struct Kept {
    experiments::Breeding::Vector individual;
    std::string name;  // that the user has given
    std::string preset;
  };

  void notify(std::string text, bool failed);
  void play_all();
  const Kept* find_kept(const experiments::Breeding::Vector& individual, const std::string* name = nullptr) const;
  void keep(const std::string& name);
  bool operate(const panel::BreedAction& action);

  Options options_;
  experiments::Breeding breeding_;
  std::vector<VariationProcess> processes_;
  std::uint64_t runs_ = 0;  // number of the last evaluation
  MouseMovement mouse_;     // all movement of the cameras so far
  panel::BreedView view_;
  std::vector<Kept> kept_;  // the latest first
};

}  // namespace limber::app
