// `limber annotate`: to stdout, into a file, and what is said when that can't be.
#include "app/annotate.h"

#include "app/program.h"

namespace limber::app_test {
namespace {

TEST(Annotate, PrintsOrWritesTheSame) {
  const Folder folder;
  const Ran printed = run({"annotate"});
  EXPECT_EQ(printed.code, 0) << printed.err;
  EXPECT_EQ(printed.out, annotations_text());
  EXPECT_TRUE(printed.out.starts_with("---@meta\n"));
  const Ran written = run({"annotate", "a/b.lua"}, folder.path());
  EXPECT_EQ(written.code, 0) << written.err;
  EXPECT_EQ(written.out, "");
  EXPECT_EQ(content(std::filesystem::path(folder.path()) / "a/b.lua"), printed.out);
  EXPECT_EQ(run({"annotate", "a/b.lua"}, folder.path()).code, 0) << "again, over the old one";
}

TEST(Annotate, AFileThatCanNotBeWrittenIsSaid) {
  const Ran ran = run({"annotate", "/proc/definitions.lua"});
  EXPECT_EQ(ran.code, 3);
  EXPECT_EQ(ran.err, "limber: /proc/definitions.lua can't be written; look at the folder's permissions\n");
}

}  // namespace
}  // namespace limber::app_test
