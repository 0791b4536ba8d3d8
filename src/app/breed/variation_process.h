// VariationProcess: a variation of a scene that plays in a child process. A process that ends or no longer answers is
// started again. [one thread]
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "app/breed/variation_protocol.h"
#include "base/result.h"
#include "base/system/child_process.h"
#include "experiments/evaluation.h"
#include "ui/render/pixels.h"

namespace limber::app {

class VariationProcess {
 public:
  static constexpr double kAnswerLimit = 30;  ///< s after which a process counts as stuck.
  static constexpr int kMaxStarts = 3;        ///< Starts for one run.

  /// `command`: the program and its arguments. `setup`: of all runs.
  VariationProcess(std::vector<std::string> command, experiments::WorkerSetup setup)
      : command_(std::move(command)), setup_(std::move(setup)) {}

  /// Ends the run and starts another one, as soon as the process has answered.
  void play(experiments::Evaluation evaluation);
  /// Requests an image, unless one is on its way. `now` in s.
  void request(const ImageRequest& request, double now);
  /// Reads the bytes that have arrived. Returns true if they complete an image of the run.
  bool read();
  /// Gives up a process that hasn't answered for kAnswerLimit.
  void check(double now);

  /// Descriptor to wait for; -1: the process doesn't run.
  int descriptor() const { return process_ == nullptr ? -1 : process_->output(); }
  const render::Pixels& image() const { return image_; }
  /// True if the run has failed before its first image; image() is that of a run before, if any.
  bool failed() const { return !error_.empty() && !has_image_; }
  /// Reason why the run doesn't play as it should; empty: it does.
  const std::string& error() const { return error_; }

 private:
  bool start();
  void lose(const char* reason);
  bool take_message();

  std::vector<std::string> command_;
  experiments::WorkerSetup setup_;
  experiments::Evaluation evaluation_;
  std::unique_ptr<system::ChildProcess> process_;
  bool set_up_ = false;     // the process has the setup
  bool sent_ = true;        // the process has the evaluation
  bool awaits_ = false;     // an answer
  double asked_at_ = 0;     // time of the last request, s
  int starts_ = 0;          // for this run
  bool has_image_ = false;  // image_ shows this run
  std::string received_;
  std::string error_;
  render::Pixels image_;
};

}  // namespace limber::app
