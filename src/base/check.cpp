// Where a failed CHECK goes.
#include "base/check.h"

#include "base/log.h"

namespace limber {

namespace {
std::atomic<CheckHook> hook{nullptr};
}

void set_check_hook(CheckHook h) { hook.store(h); }

void detail::check_failed(const char* condition, const char* file, int line, std::atomic<bool>& said) {
  if (const CheckHook h = hook.load()) return h(condition, file, line);
  if (said.exchange(true)) return;
  log_error("a fault of limber's own at {}:{}: '{}' does not hold; please report it", file, line, condition);
}

}  // namespace limber
