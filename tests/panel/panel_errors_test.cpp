// Errors with file and line: copied by a click, removed when fixed.
#include "panel/rig.h"
#include "ui/panel/widgets/error_list.h"

namespace limber::panel::test {
namespace {

TEST(PanelErrors, ParsesLocations) {
  EXPECT_EQ(parse_error_line({1, LogLevel::error, "scripts/a.lua:12: attempt to index a nil value"}).location,
            "scripts/a.lua:12");
  EXPECT_EQ(parse_error_line({1, LogLevel::error, "scripts/a.lua:12: attempt to index a nil value"}).file,
            "scripts/a.lua");
  EXPECT_EQ(parse_error_line({1, LogLevel::warning, "time runs at 0.5 × real time"}).location, "");
  EXPECT_EQ(parse_error_line({1, LogLevel::error, "x.lua: no line"}).location, "");
}

TEST(PanelErrors, CountsWarningsSeparately) {
  ErrorList list;
  EXPECT_EQ(list.count_text(), "");
  list.add({1, LogLevel::warning, "one"});
  EXPECT_EQ(list.count_text(), "1 warning");
  list.add({2, LogLevel::warning, "two"});
  EXPECT_EQ(list.count_text(), "2 warnings");
  ErrorList errors;
  errors.add({1, LogLevel::error, "one"});
  EXPECT_EQ(errors.count_text(), "1");
}

TEST(PanelErrors, RemovesErrorsOfFixedFile) {
  ErrorList list;
  list.add({1, LogLevel::error, "a.lua:1: one"});
  list.add({2, LogLevel::error, "b.lua:1: two"});
  list.add({3, LogLevel::warning, "a.lua:3: three"});
  list.add({4, LogLevel::info, std::string("a.lua") + std::string(kResolvedSuffix)});
  ASSERT_EQ(list.entries().size(), 2u);
  EXPECT_EQ(list.entries()[0].file, "b.lua");
  EXPECT_EQ(list.error_count(), 1u) << "a warning is no error";
  EXPECT_EQ(list.count_text(), "1 + 1 warning");
  for (int i = 0; i < 2000; i++) list.add({5, LogLevel::error, "c.lua:1: again"});
  EXPECT_EQ(list.entries().size(), ErrorList::kMaxEntries);
}

TEST(PanelErrors, ShowsSceneErrorAndCopiesLocation) {
  PanelFixture fixture(R"(local n = 0
sim:on_step(function() n = n + 1; if n == 2 then local x = nil; x.y = 1 end end))");
  const std::uint64_t before = fixture.gui->context().errors;
  fixture.show.ticks(3);
  fixture.frames(2);
  EXPECT_EQ(fixture.gui->context().errors, before + 1);
  fixture.click("tab:errors");
  fixture.click("error.0");
  EXPECT_TRUE(fixture.clipboard.ends_with("scene.lua:2")) << fixture.clipboard;
  fixture.click("errors.clear");
  EXPECT_EQ(fixture.gui->context().errors, 0u);
}

}  // namespace
}  // namespace limber::panel::test
