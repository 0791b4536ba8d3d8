// `limber annotate`: output to stdout and to a file, and errors.
#include "app/commands/commands.h"

#include "app/program.h"

namespace limber::app::test {
namespace {

TEST(Annotate, PrintsOrWritesTheSame) {
  const TempFolder folder;
  const RunResult printed = run({"annotate"});
  EXPECT_EQ(printed.code, 0) << printed.err;
  EXPECT_EQ(printed.out, annotations_text());
  EXPECT_TRUE(printed.out.starts_with("---@meta\n"));
  const RunResult written = run({"annotate", "a/b.lua"}, folder.path());
  EXPECT_EQ(written.code, 0) << written.err;
  EXPECT_EQ(written.out, "");
  EXPECT_EQ(content(std::filesystem::path(folder.path()) / "a/b.lua"), printed.out);
  EXPECT_EQ(run({"annotate", "a/b.lua"}, folder.path()).code, 0) << "overwrites its own output";
}

TEST(Annotate, ReportsAnUnwritableFile) {
  const RunResult result = run({"annotate", "/proc/definitions.lua"});
  EXPECT_EQ(result.code, 3);
  EXPECT_EQ(result.err, "limber: /proc/definitions.lua can't be written; check the folder's permissions\n");
}

}  // namespace
}  // namespace limber::app::test
