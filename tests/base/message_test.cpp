// Who sent a message, in words.
#include "base/message.h"

#include <gtest/gtest.h>

namespace limber {
namespace {

TEST(Message, EveryHandHasItsName) {
  EXPECT_EQ(sender_text({Hand::osc, 0xc0a80105, 57120}), "192.168.1.5:57120");
  EXPECT_EQ(sender_text({Hand::query, 0x7f000001, 9003}), "127.0.0.1:9003");
  EXPECT_EQ(sender_text({Hand::osc}), "osc");
  EXPECT_EQ(sender_text({Hand::query}), "query");
  EXPECT_EQ(sender_text({Hand::command_line}), "command_line");
  EXPECT_EQ(sender_text({Hand::console}), "console");
  EXPECT_EQ(sender_text({Hand::panel}), "panel");
  EXPECT_EQ(sender_text({Hand::script}), "script");
}

}  // namespace
}  // namespace limber
