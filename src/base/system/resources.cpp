// Checks limits by trying, because they include the resources of the user's other programs.
#include "base/system/resources.h"

#include <sys/resource.h>

#include <future>
#include <system_error>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "base/system/descriptor.h"
#include "base/system/file.h"

namespace limber::system {

namespace {

int count_descriptors(int max_count) {
  std::vector<Descriptor> opened;
  while (static_cast<int>(opened.size()) < max_count) {
    Descriptor one = open_file("/dev/null", OpenMode::read);
    if (!one.is_open()) break;
    opened.push_back(std::move(one));
  }
  return static_cast<int>(opened.size());
}

int count_threads(int max_count) {
  std::vector<std::thread> started;
  started.reserve(static_cast<std::size_t>(max_count));
  std::promise<void> end;
  const std::shared_future<void> ended = end.get_future().share();
  try {
    while (static_cast<int>(started.size()) < max_count) started.emplace_back([ended] { ended.wait(); });
  } catch (const std::system_error&) {
    // the limit is reached
  }
  end.set_value();
  for (std::thread& thread : started) thread.join();
  return static_cast<int>(started.size());
}

}  // namespace

Result<void> check_resources(const Resources& needed) {
  rlimit stack{};
  if (getrlimit(RLIMIT_STACK, &stack) == 0 && stack.rlim_cur != RLIM_INFINITY && stack.rlim_cur < needed.stack) {
    return Error{fmt::format("the stack is limited to {} KiB, and {} are needed: ulimit -s 8192", stack.rlim_cur / 1024,
                             needed.stack / 1024)};
  }
  if (const int found = count_descriptors(needed.descriptors); found < needed.descriptors) {
    return Error{fmt::format("only {} more files and sockets can be opened, and {} are needed: ulimit -n 1024", found,
                             needed.descriptors)};
  }
  if (const int found = count_threads(needed.threads); found < needed.threads) {
    return Error{
        fmt::format("only {} more threads can be started, and {} are needed: raise ulimit -u, or end other "
                    "programs of this user. Threads need memory, too: ulimit -v",
                    found, needed.threads)};
  }
  return {};
}

}  // namespace limber::system
