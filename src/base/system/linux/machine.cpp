// Heap size from glibc, processor model from /proc/cpuinfo, suspended time from the kernel's clocks.
#include <malloc.h>

#include <ctime>
#include <fstream>

#include "base/system/clock.h"
#include "base/system/process.h"

namespace limber::system {

bool is_portable() { return false; }

std::string processor_name() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return {};
}

double heap_bytes() {
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks) + static_cast<double>(info.hblkhd);
}

double suspended_seconds() {
  timespec all{};
  timespec awake{};
  clock_gettime(CLOCK_MONOTONIC, &awake);
  clock_gettime(CLOCK_BOOTTIME, &all);
  return static_cast<double>(all.tv_sec - awake.tv_sec) + 1e-9 * static_cast<double>(all.tv_nsec - awake.tv_nsec);
}

}  // namespace limber::system
