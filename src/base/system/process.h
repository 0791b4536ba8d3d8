// This program as the system sees it, other programs, and the machine. [any]
#pragma once

#include <cstddef>
#include <string>

namespace limber::system {

int process_id();
/// Whether a program with this number runs, of whatever user.
bool process_runs(int pid);
/// The user that the program runs as.
long user_id();

constexpr int kStandardInput = 0;
/// Whether both standard input and standard output are a terminal.
bool at_terminal();

/// The name of this machine in its network; empty when it has none.
std::string host_name();
/// The kernel and the processor: "Linux x86_64".
std::string machine_name();

/// Whether this build makes POSIX calls only (LIMBER_PORTABLE), on Linux too.
bool is_portable();

/// The processor's model; empty where the system does not name it.
std::string processor_name();

/// Bytes that the program holds on its heap; 0 where the system does not count them.
double heap_bytes();

/// The function of this name in the program or a library that it has loaded. Null: none.
void* find_symbol(const char* name);
/// Loads a shared library for the rest of the process: "libEGL.so.1". False where it can't be loaded.
bool load_library(const char* file);

}  // namespace limber::system
