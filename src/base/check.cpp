// Reports failed checks to the hook or the log.
#include "base/check.h"

#include "base/log/log.h"

namespace limber {

namespace {
std::atomic<CheckHook> hook{nullptr};
}

void set_check_hook(CheckHook h) { hook.store(h); }

void detail::check_failed(const char* condition, const char* file, int line, std::atomic<bool>& reported) {
  if (const CheckHook h = hook.load()) return h(condition, file, line);
  if (reported.exchange(true)) return;
  log_error("internal error at {}:{}: the check '{}' failed. Please report this", file, line, condition);
}

}  // namespace limber
