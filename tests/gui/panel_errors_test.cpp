// Errors: with file and line, copied by a click, gone when mended.
#include "gui/fault_list.h"
#include "gui/rig.h"

namespace limber::gui_test {
namespace {

TEST(PanelErrors, PlacesAreRead) {
  EXPECT_EQ(fault_of({1, LogLevel::error, "scripts/a.lua:12: attempt to index a nil value"}).place, "scripts/a.lua:12");
  EXPECT_EQ(fault_of({1, LogLevel::error, "scripts/a.lua:12: attempt to index a nil value"}).file, "scripts/a.lua");
  EXPECT_EQ(fault_of({1, LogLevel::warning, "time runs at 0.5 × real time"}).place, "");
  EXPECT_EQ(fault_of({1, LogLevel::error, "x.lua: no line"}).place, "");
}

TEST(PanelErrors, TheCountSaysWhatIsAWarning) {
  FaultList list;
  EXPECT_EQ(list.count_text(), "");
  list.hear({1, LogLevel::warning, "one"});
  EXPECT_EQ(list.count_text(), "1 warning");
  list.hear({2, LogLevel::warning, "two"});
  EXPECT_EQ(list.count_text(), "2 warnings");
  FaultList errors;
  errors.hear({1, LogLevel::error, "one"});
  EXPECT_EQ(errors.count_text(), "1");
}

TEST(PanelErrors, VanishWhenTheirFileIsMended) {
  FaultList list;
  list.hear({1, LogLevel::error, "a.lua:1: one"});
  list.hear({2, LogLevel::error, "b.lua:1: two"});
  list.hear({3, LogLevel::warning, "a.lua:3: three"});
  list.hear({4, LogLevel::info, std::string("a.lua") + std::string(kMended)});
  ASSERT_EQ(list.faults().size(), 2u);
  EXPECT_EQ(list.faults()[0].file, "b.lua");
  EXPECT_EQ(list.errors(), 1u) << "a warning is no error";
  EXPECT_EQ(list.count_text(), "1 + 1 warning");
  for (int i = 0; i < 2000; i++) list.hear({5, LogLevel::error, "c.lua:1: again"});
  EXPECT_EQ(list.faults().size(), FaultList::kMost);
}

TEST(PanelErrors, AFaultOfTheSceneStandsInThePanelAndAClickCopiesItsPlace) {
  PanelRig rig(R"(local n = 0
sim:on_step(function() n = n + 1; if n == 2 then local x = nil; x.y = 1 end end))");
  const std::uint64_t before = rig.gui->desk().errors;
  rig.show.ticks(3);
  rig.frames(2);
  EXPECT_EQ(rig.gui->desk().errors, before + 1);
  rig.click("tab:errors");
  rig.click("error.0");
  EXPECT_TRUE(rig.clipboard.ends_with("scene.lua:2")) << rig.clipboard;
  rig.click("errors.clear");
  EXPECT_EQ(rig.gui->desk().errors, 0u);
}

}  // namespace
}  // namespace limber::gui_test
