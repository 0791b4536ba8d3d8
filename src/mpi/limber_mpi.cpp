// limber-mpi-*.so: MPI for limber, compiled once for each installed implementation (experiments/mpi_module.h).
// [the thread that called start()]
#include <mpi.h>

#include <cstdlib>
#include <limits>
#include <list>
#include <string>

#include "experiments/mpi_module.h"

namespace {

constexpr int kTag = 1;

struct Sending {
  std::string bytes;
  MPI_Request request = MPI_REQUEST_NULL;
};
// nodes of a list stay where they are, as MPI reads the bytes later
std::list<Sending>& sending() {
  static std::list<Sending> list;
  return list;
}

bool start(int* rank, int* size) {
  // the rank starts child processes, but they don't use MPI
  (void)setenv("OMPI_MCA_mpi_warn_on_fork", "0", 0);
  int provided = 0;
  return MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided) == MPI_SUCCESS &&
         MPI_Comm_rank(MPI_COMM_WORLD, rank) == MPI_SUCCESS && MPI_Comm_size(MPI_COMM_WORLD, size) == MPI_SUCCESS;
}

void send(int rank, const char* bytes, std::size_t size) {
  if (size > static_cast<std::size_t>(std::numeric_limits<int>::max())) MPI_Abort(MPI_COMM_WORLD, 3);
  Sending& message = sending().emplace_back();
  message.bytes.assign(bytes, size);
  MPI_Isend(message.bytes.data(), static_cast<int>(size), MPI_BYTE, rank, kTag, MPI_COMM_WORLD, &message.request);
}

bool probe(int* rank, std::size_t* size) {
  sending().remove_if([](Sending& message) {
    int sent = 0;
    MPI_Test(&message.request, &sent, MPI_STATUS_IGNORE);
    return sent != 0;
  });
  int arrived = 0;
  MPI_Status status;
  MPI_Iprobe(MPI_ANY_SOURCE, kTag, MPI_COMM_WORLD, &arrived, &status);
  if (arrived == 0) return false;
  int count = 0;
  MPI_Get_count(&status, MPI_BYTE, &count);
  *rank = status.MPI_SOURCE;
  *size = static_cast<std::size_t>(count);
  return true;
}

void receive(int rank, char* bytes, std::size_t size) {
  MPI_Recv(bytes, static_cast<int>(size), MPI_BYTE, rank, kTag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
}

void finish() {
  for (Sending& message : sending()) MPI_Wait(&message.request, MPI_STATUS_IGNORE);
  sending().clear();
  MPI_Finalize();
}

}  // namespace

extern "C" __attribute__((visibility("default"))) const LimberMpiModule* limber_mpi_module() {
  static const LimberMpiModule module{limber::experiments::kMpiModuleVersion, start, send, probe, receive, finish};
  return &module;
}
