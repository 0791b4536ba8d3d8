// Formatting the sender of a message.
#include "base/message.h"

#include <gtest/gtest.h>

namespace limber {
namespace {

TEST(Message, EverySourceHasAName) {
  EXPECT_EQ(sender_text({CommandSource::osc, 0xc0a80105, 57120}), "192.168.1.5:57120");
  EXPECT_EQ(sender_text({CommandSource::oscquery, 0x7f000001, 9003}), "127.0.0.1:9003");
  EXPECT_EQ(sender_text({CommandSource::osc}), "osc");
  EXPECT_EQ(sender_text({CommandSource::oscquery}), "query");
  EXPECT_EQ(sender_text({CommandSource::command_line}), "command_line");
  EXPECT_EQ(sender_text({CommandSource::console}), "console");
  EXPECT_EQ(sender_text({CommandSource::panel}), "panel");
  EXPECT_EQ(sender_text({CommandSource::script}), "script");
}

}  // namespace
}  // namespace limber
