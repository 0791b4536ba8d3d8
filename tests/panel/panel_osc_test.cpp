// The OSC monitor logs messages only while it is visible, and shows frequent addresses less often.
#include "panel/rig.h"

namespace limber::panel::test {
namespace {

TEST(PanelOsc, LogsOnlyWhileVisible) {
  PanelFixture fixture;
  fixture.frames(3);
  EXPECT_TRUE(fixture.show.link.message_log.enabled());
  fixture.key(GuiKey::f1);
  fixture.frames(80);
  EXPECT_FALSE(fixture.show.link.message_log.enabled()) << "hidden: nothing is noted";
  fixture.key(GuiKey::f1);
  fixture.frames(3);
  EXPECT_TRUE(fixture.show.link.message_log.enabled());
}

TEST(PanelOsc, ThinsOutFrequentAddresses) {
  PanelFixture fixture;
  fixture.frames(3);
  for (int i = 0; i < 100; i++)
    fixture.show.link.message_log.add(true, "127.0.0.1:4000", {"/often", {Arg::of(1.0 * i)}});
  fixture.show.link.message_log.add(false, "127.0.0.1:9005", {"/once", {}});
  fixture.frames(3);
  ASSERT_TRUE(fixture.is_visible("osc.line1"));
  EXPECT_FALSE(fixture.is_visible("osc.line2")) << "a hundred of one address are one line";
  fixture.click("osc.line0");
  EXPECT_EQ(fixture.clipboard, "/often 0");
  fixture.click("osc.line1");
  EXPECT_EQ(fixture.clipboard, "/once");
}

TEST(PanelOsc, AddsAndRemovesTargets) {
  PanelFixture fixture;
  std::vector<std::string> requests;
  fixture.show.link.on_osc_request = [&](const Message& message, const CommandOrigin& origin) -> Result<void> {
    EXPECT_EQ(origin.source, CommandSource::panel);
    requests.push_back(message.address + (message.args.empty() ? "" : " " + message.args[0].text));
    return {};
  };
  fixture.show.link.osc.set_targets("127.0.0.1:9005 (pos at 60 Hz)\n[::1]:9006 (pos at 30 Hz)");
  fixture.frames(3);
  fixture.click("osc.targets");
  fixture.frames(2);
  fixture.click("osc.target1.remove");
  fixture.click("osc.target");
  fixture.type("pi.local:9000,rate=10");
  fixture.frames(2);
  fixture.click("osc.target.add");
  fixture.click("osc.target.reset");
  fixture.frames(3);
  EXPECT_EQ(requests, (std::vector<std::string>{"/osc/target/remove [::1]:9006",
                                                "/osc/target/add pi.local:9000,rate=10", "/osc/target/reset"}));
  fixture.show.link.osc.set_targets("");
  fixture.frames(3);
  EXPECT_FALSE(fixture.is_visible("osc.target0"));
}

}  // namespace
}  // namespace limber::panel::test
