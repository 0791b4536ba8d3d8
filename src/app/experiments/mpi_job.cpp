// The environments of launchers, the modules, and the loop of other ranks.
#include "app/experiments/mpi_job.h"

#include <cstdlib>
#include <utility>

#include <fmt/format.h>

#include "app/exit_code.h"
#include "app/experiments/module.h"
#include "app/experiments/process_workers.h"
#include "app/experiments/worker.h"
#include "app/paths.h"
#include "base/build_info.h"
#include "base/system/executable_path.h"
#include "base/system/process.h"
#include "base/text.h"

namespace limber::app {

namespace {

int number_of(const Environment& environment, const char* name, int otherwise) {
  const char* const text = environment(name);
  return text == nullptr ? otherwise : static_cast<int>(parse_number(text).value_or(otherwise));
}

std::string place_of(const MpiLaunch& launch) { return fmt::format("rank {} on {}", launch.rank, system::host_name()); }

}  // namespace

std::optional<MpiLaunch> find_mpi_launch(const Environment& environment) {
  const int slurm_tasks = number_of(environment, "SLURM_STEP_NUM_TASKS", 1);
  if (environment("OMPI_COMM_WORLD_SIZE") != nullptr)
    return MpiLaunch{"openmpi", number_of(environment, "OMPI_COMM_WORLD_RANK", 0),
                     number_of(environment, "OMPI_COMM_WORLD_SIZE", 0)};
  if (environment("PMIX_RANK") != nullptr)
    return MpiLaunch{"openmpi", number_of(environment, "PMIX_RANK", 0),
                     number_of(environment, "SLURM_STEP_NUM_TASKS", 0)};
  if (environment("PMI_RANK") != nullptr)
    return MpiLaunch{"mpich", number_of(environment, "PMI_RANK", 0), number_of(environment, "PMI_SIZE", 0)};
  if (slurm_tasks > 1) return MpiLaunch{"", number_of(environment, "SLURM_PROCID", 0), slurm_tasks};
  return {};
}

Result<std::unique_ptr<MpiJob>> MpiJob::open(const std::string& choice, const Environment& environment) {
  if (choice == "off") return std::unique_ptr<MpiJob>();
  const std::optional<MpiLaunch> found = find_mpi_launch(environment);
  const bool automatic = choice.empty() || choice == "auto";
  if (!found && automatic) return std::unique_ptr<MpiJob>();
  const MpiLaunch launch = found.value_or(MpiLaunch{});
  const std::string implementation = automatic ? launch.implementation : choice;
  const std::string place = place_of(launch);
  if (implementation.empty())
    return Error{
        fmt::format("{}: srun started {} tasks without MPI. Start them with srun --mpi=pmix (Open MPI) or srun "
                    "--mpi=pmi2 (MPICH), or use --mpi off for separate runs",
                    place, launch.size)};
  const Result<const LimberMpiModule*> module = load_module<LimberMpiModule>(
      fmt::format("limber-mpi-{}.so", implementation), experiments::kMpiModuleFunction, experiments::kMpiModuleVersion,
      {fmt::format("Install lib{}-dev and build Limber again, or use another MPI with --mpi", implementation),
       "Install this MPI on the node, or build Limber again"});
  if (!module) return Error{fmt::format("{}: {}", place, module.error())};
  int rank = 0;
  int size = 0;
  if (!(*module)->start(&rank, &size))
    return Error{fmt::format("{}: MPI can't be started ({})", place, implementation)};
  std::unique_ptr<MpiJob> job(new MpiJob(**module, rank, size));
  if (launch.size > 0 && launch.size != size)
    return Error{
        fmt::format("{}: the launcher started {} ranks, but {} sees {}. Use the mpirun of the same MPI, or "
                    "choose the MPI with --mpi openmpi or --mpi mpich",
                    place, launch.size, implementation, size)};
  return job;
}

MpiJob::MpiJob(const LimberMpiModule& module, int rank, int size)
    : module_(module), rank_(static_cast<std::size_t>(rank)), size_(static_cast<std::size_t>(size)) {}

MpiJob::~MpiJob() { module_.finish(); }

void MpiJob::send(std::size_t rank, std::string_view bytes) {
  module_.send(static_cast<int>(rank), bytes.data(), bytes.size());
}

std::optional<experiments::RankMessages::Message> MpiJob::receive() {
  int from = 0;
  std::size_t size = 0;
  if (!module_.probe(&from, &size)) return {};
  Message message{static_cast<std::size_t>(from), std::string(size, '\0')};
  module_.receive(from, message.bytes.data(), size);
  return message;
}

std::string program_identity() { return fmt::format("{} {}", version(), commit()); }

int run_in_job(const ExperimentOptions& options, const std::function<int(experiments::Workers*)>& run) {
  Result<std::unique_ptr<MpiJob>> opened =
      MpiJob::open(options.mpi, [](const char* name) -> const char* { return std::getenv(name); });
  if (!opened) return fail(kMachineError, opened.error());
  MpiJob* const job = opened->get();
  if (job == nullptr) return run(nullptr);
  ProcessWorkers local(1, {system::executable_path(), std::string(kWorkerArgument)});
  if (job->rank() == 0) {
    experiments::RankWorkers workers(*job, local, program_identity());
    return run(&workers);
  }
  experiments::RankWorker worker(*job, local, program_identity(), system::host_name());
  while (worker.step()) {
  }
  return kSuccess;
}

}  // namespace limber::app
