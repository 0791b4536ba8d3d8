// SendBudget: how much subscriptions may send: bytes and values per second, for each sender and for all together. What
// all may send is shared fairly: nobody gets less because others want more than their share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <vector>

namespace limber {

/// Per second.
struct SendLimits {
  double bytes = 0;
  double values = 0;  ///< A datagram of a stream or an event counts as one.
};

/// [one thread]
class SendBudget {
 public:
  static constexpr SendLimits kEach{24e6, 20e3};  ///< Of one sender: a thousand bodies' `pos` at 60 Hz.
  static constexpr SendLimits kAll{48e6, 50e3};
  static constexpr double kBurst = 0.1;                         ///< s of a sender's limit that may be sent at once.
  static constexpr std::int64_t kWindow = 2'000'000'000;        ///< ns; how often a reduction is decided and reported.
  static constexpr std::int64_t kShortest = 1'000'000;          ///< ns between two refills.
  static constexpr std::int64_t kReportEvery = 10'000'000'000;  ///< ns, while a sender stays reduced.

  explicit SendBudget(SendLimits each = kEach, SendLimits all = kAll) : each_(each), all_(all) {}

  /// One sender's part.
  class Account {
   public:
    /// Whether so much may be sent now; counts it when so. What is larger than the burst is paid back.
    bool spend(std::size_t bytes, std::size_t values);

   private:
    friend class SendBudget;
    SendLimits left_;
    SendLimits spent_;            // in this window
    std::uint64_t withheld_ = 0;  // times, in this window
    bool reduced_ = false;
    std::int64_t reported_ = 0;
  };

  /// Begins with a whole burst. The pointer is valid until close().
  Account* open();
  void close(const Account* account);

  /// Gives what time has brought since the last call. Call it before spending. Allocates nothing while the number of
  /// accounts stays the same.
  void refill(std::int64_t now);

  /// A sender's reduction that has begun, goes on, or has ended.
  struct Report {
    const Account* account = nullptr;
    bool reduced = false;  ///< False: it gets all again.
    double bytes = 0;      ///< Per second, in the last window.
    double values = 0;
  };
  /// What is to be reported now; empty between windows.
  const std::vector<Report>& reports(std::int64_t now);
  /// How many senders are reduced at the moment.
  std::size_t reduced() const;
  /// When reports() has something to decide.
  std::int64_t window_end() const { return window_ + kWindow; }

 private:
  void share(double SendLimits::*what, double seconds);

  const SendLimits each_;
  const SendLimits all_;
  std::list<Account> accounts_;
  std::vector<double> wanted_;  // scratch
  std::vector<Report> reports_;
  std::int64_t filled_ = 0;  // ns
  std::int64_t window_ = 0;  // its beginning
  bool begun_ = false;
};

}  // namespace limber
