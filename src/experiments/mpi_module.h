// MpiModule: the functions of a module limber-mpi-*.so, which the program loads if MPI has started it. A module is
// compiled for one implementation of MPI, so the program itself depends on none. [main]
#pragma once

#include <cstddef>

extern "C" {

struct LimberMpiModule {
  int version;  ///< limber::experiments::kMpiModuleVersion
  /// Starts MPI. False on error; MPI has printed it.
  bool (*start)(int* rank, int* size);
  /// Copies the bytes and sends them in the background.
  void (*send)(int rank, const char* bytes, std::size_t size);
  /// Returns true if a message has arrived: its sender and size. Makes progress with sending.
  bool (*probe)(int* rank, std::size_t* size);
  /// Receives the message that probe() has found.
  void (*receive)(int rank, char* bytes, std::size_t size);
  /// Waits until everything is sent, and ends MPI.
  void (*finish)();
};

}  // extern "C"

namespace limber::experiments {

inline constexpr int kMpiModuleVersion = 1;
/// The function of a module that returns its functions: `const LimberMpiModule* limber_mpi_module()`.
inline constexpr const char* kMpiModuleFunction = "limber_mpi_module";

}  // namespace limber::experiments
