// Max-min fair sharing: each subscriber gets its demand, limited to an equal part of the remaining total.
#include "net/osc/send_budget.h"

#include <algorithm>
#include <utility>

namespace limber::osc {

bool SendBudget::Account::try_consume(std::size_t bytes, std::size_t values) {
  if (available_.bytes <= 0 || available_.values <= 0) {
    withheld_++;
    return false;
  }
  available_.bytes -= static_cast<double>(bytes);
  available_.values -= static_cast<double>(values);
  spent_.bytes += static_cast<double>(bytes);
  spent_.values += static_cast<double>(values);
  return true;
}

std::optional<SendBudget::Report> SendBudget::Account::end_window(std::int64_t now, double seconds) {
  const bool throttled = std::exchange(withheld_, 0) > 0;
  const bool changed = std::exchange(throttled_, throttled) != throttled;
  const SendLimits spent = std::exchange(spent_, {});
  if (!changed && !(throttled && now - reported_ >= kReportInterval)) return {};
  reported_ = now;
  return Report{this, throttled, spent.bytes / seconds, spent.values / seconds};
}

SendBudget::Account* SendBudget::open_account() {
  Account& account =
      accounts_.emplace_back(SendLimits{per_subscriber_.bytes * kBurst, per_subscriber_.values * kBurst});
  demands_.reserve(accounts_.size());
  reports_.reserve(accounts_.size());
  return &account;
}

void SendBudget::close_account(const Account* account) {
  accounts_.remove_if([account](const Account& other) { return &other == account; });
}

void SendBudget::refill(std::int64_t now) {
  if (!started_) {
    started_ = true;
    last_refill_ = window_start_ = now;
  }
  if (now - last_refill_ < kMinRefillInterval) return;
  // long pauses do not accumulate more than one burst
  const double seconds = std::min(static_cast<double>(now - last_refill_) * 1e-9, kBurst);
  last_refill_ = now;
  distribute(&SendLimits::bytes, seconds);
  distribute(&SendLimits::values, seconds);
}

void SendBudget::distribute(double SendLimits::*member, double seconds) {
  const double max = per_subscriber_.*member * seconds;
  const auto demand_of = [&](const Account& account) {
    return std::clamp(per_subscriber_.*member * kBurst - account.available(member), 0.0, max);
  };
  demands_.clear();
  for (const Account& account : accounts_) demands_.push_back(demand_of(account));
  std::ranges::sort(demands_);
  // the level up to which demands are met in full
  double remaining = total_.*member * seconds;
  double level = max;
  for (std::size_t i = 0; i < demands_.size(); i++) {
    const double part = remaining / static_cast<double>(demands_.size() - i);
    if (demands_[i] > part) {
      level = part;
      break;
    }
    remaining -= demands_[i];
  }
  for (Account& account : accounts_) account.refill(member, std::min(demand_of(account), level));
}

const std::vector<SendBudget::Report>& SendBudget::reports(std::int64_t now) {
  reports_.clear();
  if (!started_ || now - window_start_ < kWindow) return reports_;
  const double seconds = static_cast<double>(now - window_start_) * 1e-9;
  window_start_ = now;
  for (Account& account : accounts_) {
    if (const std::optional<Report> report = account.end_window(now, seconds)) reports_.push_back(*report);
  }
  return reports_;
}

std::size_t SendBudget::throttled() const {
  return static_cast<std::size_t>(std::ranges::count_if(accounts_, [](const Account& a) { return a.throttled(); }));
}

}  // namespace limber::osc
