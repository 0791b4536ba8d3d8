// Look-ups of host names: how many run at the same time, and the kind of address.
#include "net/osc/host_resolver.h"

#include <atomic>
#include <future>
#include <memory>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace limber::osc {
namespace {

using std::chrono::seconds;

constexpr std::size_t kNames = 100;
constexpr seconds kLong{60};  // reached only by failing tests

std::string name_of(std::size_t i) { return fmt::format("host{}.example", i); }

// A name server that answers once `answer` is set. Look-ups own its state, because they may outlive a test.
struct SlowServer {
  struct State {
    std::atomic<int> running{0}, most{0}, started{0};
  };
  ResolveFunction look_up() {
    return [state = state, answered = answer.get_future().share()](const std::string&, std::uint16_t port,
                                                                   IpVersion preferred) -> Result<Endpoint> {
      const int now = ++state->running;
      for (int before = state->most; now > before && !state->most.compare_exchange_weak(before, now);) continue;
      state->started++;
      answered.wait();
      state->running--;
      return Endpoint{preferred == IpVersion::v6 ? IpAddress(0xfd00, 1) : IpAddress(0x0a000001), port};
    };
  }
  std::promise<void> answer;
  std::shared_ptr<State> state = std::make_shared<State>();
};

TEST(HostResolver, LimitsTheLookUpsAtTheSameTime) {
  SlowServer server;
  HostResolver resolver(server.look_up(), [] {});
  for (int round = 0; round < 3; round++) {
    for (std::size_t i = 0; i < kNames; i++) EXPECT_FALSE(resolver.find(name_of(i), 9000));
    resolver.invalidate();
  }
  server.answer.set_value();
  const auto until = std::chrono::steady_clock::now() + kLong;
  for (std::size_t i = 0; i < kNames; i++) {
    const std::optional<Result<Endpoint>> found = resolver.wait_until(until, name_of(i), 9000);
    ASSERT_TRUE(found && found->ok()) << i;
    EXPECT_EQ(**found, (Endpoint{0x0a000001, 9000}));
  }
  EXPECT_EQ(server.state->started, static_cast<int>(kNames));
  EXPECT_LE(server.state->most, static_cast<int>(HostResolver::kMaxLookUps));
}

TEST(HostResolver, ALateAnswerIsOfTheKindThatWasAskedFor) {
  SlowServer server;
  HostResolver resolver(server.look_up(), [] {});
  EXPECT_FALSE(resolver.find(name_of(1), 9000));
  resolver.prefer(IpVersion::v6);
  resolver.invalidate();
  EXPECT_FALSE(resolver.find(name_of(1), 9000));
  server.answer.set_value();
  const auto found = resolver.wait_until(std::chrono::steady_clock::now() + kLong, name_of(1), 9000);
  ASSERT_TRUE(found && found->ok());
  EXPECT_EQ((*found)->ip, IpAddress(0xfd00, 1));
}

}  // namespace
}  // namespace limber::osc
