// SendBudget: limits the bytes and values per second that are sent to subscribers, for each subscriber and in total.
// The total is shared max-min fairly: no subscriber gets less because others demand more than their share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <optional>
#include <vector>

namespace limber::osc {

/// Limits per second.
struct SendLimits {
  double bytes = 0;
  double values = 0;  ///< A datagram of a stream or an event counts as one value.
};

/// Token buckets with max-min fair refills. [one thread]
class SendBudget {
 public:
  static constexpr SendLimits kPerSubscriber{24e6, 20e3};  ///< Per subscriber: a thousand bodies' `pos` at 60 Hz.
  static constexpr SendLimits kTotal{48e6, 50e3};
  static constexpr double kBurst = 0.1;  ///< s of a subscriber's limit that may be sent at once.
  /// ns; interval in which throttling is determined and reported.
  static constexpr std::int64_t kWindow = 2'000'000'000;
  static constexpr std::int64_t kMinRefillInterval = 1'000'000;  ///< ns; minimum time between two refills.
  /// ns; interval of repeated reports for a throttled subscriber.
  static constexpr std::int64_t kReportInterval = 10'000'000'000;

  explicit SendBudget(SendLimits per_subscriber = kPerSubscriber, SendLimits total = kTotal)
      : per_subscriber_(per_subscriber), total_(total) {}

  class Account;
  /// Reports that throttling of a subscriber has begun, continues or has ended.
  struct Report {
    const Account* account = nullptr;
    bool throttled = false;  ///< False: the subscriber is no longer throttled.
    double bytes = 0;        ///< Per second, in the last window.
    double values = 0;
  };
  /// The budget of one subscriber.
  class Account {
   public:
    explicit Account(SendLimits available) : available_(available) {}
    /// Charges the amount. Returns false if nothing is left. A charge larger than the rest is allowed; the debt is paid
    /// by later refills.
    bool try_consume(std::size_t bytes, std::size_t values);

    // Called by SendBudget.
    double available(double SendLimits::*member) const { return available_.*member; }
    void refill(double SendLimits::*member, double amount) { available_.*member += amount; }
    /// Ends a window of `seconds`; returns a report if one is due.
    std::optional<Report> end_window(std::int64_t now, double seconds);
    /// True if charges were rejected in the last window.
    bool throttled() const { return throttled_; }

   private:
    SendLimits available_;
    SendLimits spent_;            // in this window
    std::uint64_t withheld_ = 0;  // number of rejected charges in this window
    bool throttled_ = false;
    std::int64_t reported_ = 0;
  };

  /// Opens an account with a full burst. The pointer is valid until close_account().
  Account* open_account();
  void close_account(const Account* account);

  /// Refills the accounts for the time since the last call. Call it before spending. Does not allocate while the number
  /// of accounts stays the same.
  void refill(std::int64_t now);

  /// Returns the reports of the window that has ended; empty within a window.
  const std::vector<Report>& reports(std::int64_t now);
  /// Number of subscribers that are currently throttled.
  std::size_t throttled() const;
  /// End of the current window, ns; from then on reports() has new results.
  std::int64_t window_end() const { return window_start_ + kWindow; }

 private:
  void distribute(double SendLimits::*member, double seconds);

  const SendLimits per_subscriber_;
  const SendLimits total_;
  std::list<Account> accounts_;
  std::vector<double> demands_;  // scratch memory of distribute()
  std::vector<Report> reports_;
  std::int64_t last_refill_ = 0;   // time of the last refill, ns
  std::int64_t window_start_ = 0;  // start of the current window, ns
  bool started_ = false;
};

}  // namespace limber::osc
