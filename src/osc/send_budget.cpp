// Max-min fair shares: of what all may send, each sender gets what it has room for, up to an equal part of the rest.
#include "osc/send_budget.h"

#include <algorithm>

namespace limber {

bool SendBudget::Account::spend(std::size_t bytes, std::size_t values) {
  if (left_.bytes <= 0 || left_.values <= 0) {
    withheld_++;
    return false;
  }
  left_.bytes -= static_cast<double>(bytes);
  left_.values -= static_cast<double>(values);
  spent_.bytes += static_cast<double>(bytes);
  spent_.values += static_cast<double>(values);
  return true;
}

SendBudget::Account* SendBudget::open() {
  Account& account = accounts_.emplace_back();
  account.left_ = {each_.bytes * kBurst, each_.values * kBurst};
  wanted_.reserve(accounts_.size());
  reports_.reserve(accounts_.size());
  return &account;
}

void SendBudget::close(const Account* account) {
  accounts_.remove_if([account](const Account& other) { return &other == account; });
}

void SendBudget::refill(std::int64_t now) {
  if (!begun_) {
    begun_ = true;
    filled_ = window_ = now;
  }
  if (now - filled_ < kShortest) return;
  // what was not used in a long pause is not kept
  const double seconds = std::min(static_cast<double>(now - filled_) * 1e-9, kBurst);
  filled_ = now;
  share(&SendLimits::bytes, seconds);
  share(&SendLimits::values, seconds);
}

void SendBudget::share(double SendLimits::*what, double seconds) {
  const double most = each_.*what * seconds;
  const auto wanted_by = [&](const Account& account) {
    return std::clamp(each_.*what * kBurst - account.left_.*what, 0.0, most);
  };
  wanted_.clear();
  for (const Account& account : accounts_) wanted_.push_back(wanted_by(account));
  std::ranges::sort(wanted_);
  // the level up to which wishes are fulfilled
  double rest = all_.*what * seconds;
  double level = most;
  for (std::size_t i = 0; i < wanted_.size(); i++) {
    const double part = rest / static_cast<double>(wanted_.size() - i);
    if (wanted_[i] > part) {
      level = part;
      break;
    }
    rest -= wanted_[i];
  }
  for (Account& account : accounts_) account.left_.*what += std::min(wanted_by(account), level);
}

const std::vector<SendBudget::Report>& SendBudget::reports(std::int64_t now) {
  reports_.clear();
  if (!begun_ || now - window_ < kWindow) return reports_;
  const double seconds = static_cast<double>(now - window_) * 1e-9;
  window_ = now;
  for (Account& account : accounts_) {
    const bool reduced = account.withheld_ > 0;
    const bool changed = reduced != account.reduced_;
    if (changed || (reduced && now - account.reported_ >= kReportEvery)) {
      reports_.push_back({&account, reduced, account.spent_.bytes / seconds, account.spent_.values / seconds});
      account.reported_ = now;
    }
    account.reduced_ = reduced;
    account.withheld_ = 0;
    account.spent_ = {};
  }
  return reports_;
}

std::size_t SendBudget::reduced() const {
  return static_cast<std::size_t>(std::ranges::count_if(accounts_, [](const Account& a) { return a.reduced_; }));
}

}  // namespace limber
