// Markdown for generated pages.
#include "base/markdown.h"

#include <gtest/gtest.h>

namespace limber {
namespace {

TEST(Markdown, WrapsWithoutBeginningAList) {
  const std::string text(115, 'x');
  EXPECT_EQ(wrapped(text + " abcd e"), text + " abcd\ne\n");
  EXPECT_EQ(wrapped(text + " abc + d"), text + "\nabc + d\n") << "a line that begins with + would be a list";
  EXPECT_EQ(wrapped(text + " éééé e"), text + " éééé\ne\n") << "columns, not bytes";
  EXPECT_EQ(wrapped("a b", "- "), "- a b\n");
  EXPECT_EQ(wrapped(std::string(120, 'x') + " y", "- "), "- " + std::string(120, 'x') + "\n  y\n");
}

TEST(Markdown, EscapesHtmlOutsideOfCode) {
  EXPECT_EQ(markdown_text("/scene/<name>\nor `<body>`"), "/scene/&lt;name> or `<body>`");
}

TEST(Markdown, FindsTheFirstSentence) {
  EXPECT_EQ(first_sentence("From 0 .. 1, else 0.5. More."), "From 0 .. 1, else 0.5.");
  EXPECT_EQ(first_sentence("Only one"), "Only one");
}

TEST(Markdown, MakesAnchorsLikeTheSite) {
  EXPECT_EQ(heading_anchor("`body:add_part`"), "bodyadd_part");
  EXPECT_EQ(heading_anchor("All names"), "all-names");
}

}  // namespace
}  // namespace limber
