// Information about this process, other processes and the machine; dynamic libraries. [any]
#pragma once

#include <cstddef>
#include <string>

namespace limber::system {

int process_id();
/// True if a process with this id is running, under any user.
bool is_process_running(int pid);
/// Returns the effective user id.
long user_id();

constexpr int kStandardInput = 0;
/// True if standard input and standard output are terminals.
bool at_terminal();

/// Returns the host name; empty if there is none.
std::string host_name();
/// Returns the operating system and architecture: "Linux x86_64".
std::string machine_name();

/// True if this build uses POSIX calls only (LIMBER_PORTABLE), which is possible on Linux too.
bool is_portable();

/// Returns the model name of the processor; empty if unknown.
std::string processor_name();

/// Returns how often this process and its ancestors have forked since the first call in one of them: it differs in a
/// child. A lock-free read. [any]
unsigned fork_count();

/// Returns the bytes allocated on the heap; 0 if the system does not count them.
double heap_bytes();

/// Returns the function of this name in the program or a loaded library, or null.
void* find_symbol(const char* name);
/// Returns the absolute path of the program or library that contains this address; empty if it is unknown.
std::string library_path(const void* address);
/// Loads a shared library such as "libEGL.so.1" until the process exits. False on error.
bool load_library(const char* file);
/// Loads a shared library until the process exits, and returns its function; null on error, with the reason.
void* load_function(const std::string& file, const char* name, std::string& reason);

}  // namespace limber::system
