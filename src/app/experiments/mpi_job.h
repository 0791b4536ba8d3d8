// MpiJob: the job of an MPI launcher (mpirun, mpiexec, srun) that started this program as one of its ranks. The module
// of the implementation is loaded at run time. [main]
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "app/experiments/experiment_options.h"
#include "base/result.h"
#include "experiments/mpi_module.h"
#include "experiments/ranks.h"

namespace limber::app {

/// How MPI started this process, as its environment says.
struct MpiLaunch {
  std::string implementation;  ///< openmpi, mpich; empty: tasks of Slurm without MPI.
  int rank = 0;
  int size = 0;  ///< 0: unknown.
};

/// Returns an environment variable, or null.
using Environment = std::function<const char*(const char* name)>;
/// Returns nullopt if no launcher started the process.
std::optional<MpiLaunch> find_mpi_launch(const Environment& environment);

class MpiJob final : public experiments::RankMessages {
 public:
  /// Starts MPI. `choice`: auto, openmpi, mpich or off. Null if there is no job. Errors name the rank and the host.
  static Result<std::unique_ptr<MpiJob>> open(const std::string& choice, const Environment& environment);
  ~MpiJob() override;

  std::size_t rank() const override { return rank_; }
  std::size_t size() const override { return size_; }
  void send(std::size_t rank, std::string_view bytes) override;
  std::optional<Message> receive() override;

 private:
  MpiJob(const LimberMpiModule& module, int rank, int size);

  const LimberMpiModule& module_;
  std::size_t rank_;
  std::size_t size_;
};

/// Returns the version of the program, which must be the same on all ranks.
std::string program_identity();

/// Runs an experiment: calls `run` with the workers of all ranks, or with null without MPI. On other ranks than 0 it
/// works for rank 0 instead, and returns 0.
int run_in_job(const ExperimentOptions& options, const std::function<int(experiments::Workers*)>& run);

}  // namespace limber::app
