// How the program detects that MPI has started it.
#include "app/experiments/mpi_job.h"

#include <map>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "app/push_scene.h"

namespace limber::app::test {
namespace {

std::optional<MpiLaunch> found(const std::map<std::string, std::string>& variables) {
  return find_mpi_launch([&](const char* name) {
    const auto entry = variables.find(name);
    return entry == variables.end() ? nullptr : entry->second.c_str();
  });
}

void expect_launch(const std::map<std::string, std::string>& variables, const char* implementation, int rank,
                   int size) {
  const std::optional<MpiLaunch> launch = found(variables);
  ASSERT_TRUE(launch.has_value());
  EXPECT_EQ(launch->implementation, implementation);
  EXPECT_EQ(launch->rank, rank);
  EXPECT_EQ(launch->size, size);
}

TEST(MpiJob, LaunchersAreDetected) {
  EXPECT_FALSE(found({}).has_value());
  expect_launch({{"OMPI_COMM_WORLD_SIZE", "4"}, {"OMPI_COMM_WORLD_RANK", "3"}, {"PMIX_RANK", "3"}}, "openmpi", 3, 4);
  expect_launch({{"PMIX_RANK", "2"}, {"SLURM_STEP_NUM_TASKS", "3"}}, "openmpi", 2, 3);
  expect_launch({{"PMI_RANK", "1"}, {"PMI_SIZE", "2"}}, "mpich", 1, 2);
  expect_launch({{"PMI_RANK", "1"}, {"PMI_SIZE", "2"}, {"SLURM_STEP_NUM_TASKS", "2"}}, "mpich", 1, 2);
  expect_launch({{"SLURM_STEP_NUM_TASKS", "8"}, {"SLURM_PROCID", "5"}}, "", 5, 8);
  // a batch script, and a step with one task
  EXPECT_FALSE(found({{"SLURM_NTASKS", "8"}, {"SLURM_PROCID", "0"}}).has_value());
  EXPECT_FALSE(found({{"SLURM_STEP_NUM_TASKS", "1"}, {"SLURM_PROCID", "0"}}).has_value());
}

TEST(MpiJob, TasksWithoutMpiDoNotOverwriteEachOther) {
  const TempFolder folder;
  folder.file("push.lua", kPush);
  std::vector<std::string> words = limber_command({"sweep", "push.lua", "--samples", "4", "--out", "t.csv"});
  words.insert(words.begin(), {"env", "SLURM_STEP_NUM_TASKS=8", "SLURM_PROCID=5"});
  const RunResult result = Process(words, folder.path()).finish();
  EXPECT_EQ(result.code, 3);
  EXPECT_NE(result.err.find("srun started 8 tasks without MPI. Start them with srun --mpi=pmix"), std::string::npos)
      << result.err;
  EXPECT_NE(result.err.find("rank 5 on "), std::string::npos) << result.err;
  EXPECT_EQ(content(folder.path() + "/t.csv"), "");
  words.insert(words.end(), {"--mpi", "off", "--duration", "0.1"});
  EXPECT_EQ(Process(words, folder.path()).finish().code, 0);
  EXPECT_EQ(rows(content(folder.path() + "/t.csv")).size(), 5u);
}

}  // namespace
}  // namespace limber::app::test
