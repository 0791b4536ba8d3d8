// Sanitizing of a file's bytes: encodings, control characters, declarations, depth, truncated files.
#include "model/xml_text.h"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "import_text.h"

namespace limber::model {
namespace {

struct Cleaned {
  std::string text;
  std::vector<Problem> problems;
};

Cleaned clean(std::string_view bytes) {
  Problems problems;
  const Result<std::string> text = clean_urdf_text(bytes, problems);
  return {text ? *text : "rejected: " + text.error(), problems.release()};
}

TEST(UrdfText, KeepsPlainTextUnchanged) {
  const std::string text = "<robot name=\"r\">\n <!-- <a> --> <link name='x>y'/> <![CDATA[</robot>]]>\n</robot>";
  const Cleaned c = clean(text);
  EXPECT_EQ(c.text, text);
  EXPECT_TRUE(c.problems.empty());
}

TEST(UrdfText, ConvertsLatin1) {
  const Cleaned c = clean("<robot>\n<link name=\"gel\xE4nk\"/></robot>");
  EXPECT_EQ(c.text, "<robot>\n<link name=\"gel\xC3\xA4nk\"/></robot>");
  ASSERT_EQ(c.problems.size(), 1u);
  EXPECT_EQ(c.problems[0].line, 2);
}

TEST(UrdfText, KeepsValidUtf8AndConvertsInvalidSequences) {
  EXPECT_EQ(clean("<a b=\"\xE2\x82\xAC\xF0\x9F\xA4\x96\"/>").text, "<a b=\"\xE2\x82\xAC\xF0\x9F\xA4\x96\"/>");
  // overlong, surrogate, beyond Unicode, truncated
  EXPECT_EQ(clean("<a b=\"\xC0\xAF\"/>").text, "<a b=\"\xC3\x80\xC2\xAF\"/>");
  EXPECT_EQ(clean("<a b=\"\xED\xA0\x80\"/>").text, "<a b=\"\xC3\xAD\xC2\xA0\xC2\x80\"/>");
  EXPECT_EQ(clean("<a b=\"\xF4\x90\x80\x80\"/>").text, "<a b=\"\xC3\xB4\xC2\x90\xC2\x80\xC2\x80\"/>");
  EXPECT_EQ(clean("<a>\xE2\x82").text, "<a>\xC3\xA2\xC2\x82");
}

TEST(UrdfText, ReplacesAndReportsNul) {
  const Cleaned c = clean(std::string_view("<robot>\n\0<link/></robot>", 24));
  EXPECT_EQ(c.text, "<robot>\n <link/></robot>");
  ASSERT_EQ(c.problems.size(), 1u);
  EXPECT_EQ(c.problems[0].line, 2);
  EXPECT_EQ(c.problems[0].severity, Severity::error);
}

TEST(UrdfText, HandlesByteOrderMarks) {
  EXPECT_EQ(clean("\xEF\xBB\xBF<a/>").text, "<a/>");
  EXPECT_NE(clean(std::string_view("\xFF\xFE<\0a\0", 6)).text.find("UTF-16"), std::string::npos);
}

TEST(UrdfText, BlanksDeclarationsInPlace) {
  const Cleaned c = clean("<?xml version=\"1.0\"?>\n<!DOCTYPE r [<!ENTITY x \"]>\">\n]><a/>");
  EXPECT_EQ(c.text.substr(c.text.find('<')), "<a/>");
  EXPECT_EQ(std::count(c.text.begin(), c.text.end(), '\n'), 2);
  ASSERT_EQ(c.problems.size(), 1u);
  EXPECT_NE(c.problems[0].text.find("DOCTYPE"), std::string::npos);
  EXPECT_EQ(c.problems[0].line, 2);
}

TEST(UrdfText, RemovesOnlyElementsThatAreTooDeep) {
  std::string deep = "<robot>";
  for (int i = 0; i < 60000; ++i) deep += "<a>";
  for (int i = 0; i < 60000; ++i) deep += "</a>";
  const Cleaned c = clean(deep + "<link/></robot>");
  EXPECT_NE(c.text.find("<link/>"), std::string::npos);
  std::size_t open = 0;
  for (std::size_t at = c.text.find("<a>"); at != std::string::npos; at = c.text.find("<a>", at + 1)) ++open;
  EXPECT_EQ(open, static_cast<std::size_t>(kMaxUrdfDepth - 1));
  ASSERT_EQ(c.problems.size(), 1u);
}

TEST(UrdfText, RemovesUnclosedDeepElements) {
  std::string deep;
  for (int i = 0; i < 60000; ++i) deep += "<a>";
  EXPECT_LT(clean(deep).text.find_last_of('>'), 3u * static_cast<unsigned>(kMaxUrdfDepth));
}

TEST(UrdfText, RemovesTextAfterTheRoot) {
  const Cleaned c = clean("<a></a>\n<<<>>>&&&");
  EXPECT_EQ(c.text, "<a></a>");
  ASSERT_EQ(c.problems.size(), 1u);
  EXPECT_EQ(c.problems[0].line, 2);
  EXPECT_TRUE(clean("<a/>\n<!-- end -->").problems.empty());
}

TEST(UrdfText, QuotesBareAttributeValues) {
  const Cleaned c = clean("<robot name=r ><link name=a/><link name = b></link></robot>");
  EXPECT_EQ(c.text, "<robot name=\"r\" ><link name=\"a\"/><link name = \"b\"></link></robot>");
  ASSERT_EQ(c.problems.size(), 1u);
}

TEST(UrdfText, BoundsTheNumberOfAttributes) {
  std::string many = "<robot name=\"r\"";
  for (int i = 0; i < 100000; ++i) many += " a" + std::to_string(i) + "=\"1\"";
  const Cleaned c = clean(many + "><link/></robot>");
  EXPECT_EQ(std::count(c.text.begin(), c.text.end(), '='), 64);
  EXPECT_NE(c.text.find("><link/></robot>"), std::string::npos);
}

TEST(UrdfText, RejectsUnreadableFilesByName) {
  const Result<std::string> missing = read_whole_file("no_such_file_%s.urdf", 100);
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().find("no_such_file_%s.urdf: file not found"), std::string::npos);
  const Result<std::string> folder = read_whole_file("/", 100);
  ASSERT_FALSE(folder);
  EXPECT_NE(folder.error().find("not a file"), std::string::npos);
  const Result<std::string> large = read_whole_file(LIMBER_SOURCE_DIR "/CMakeLists.txt", 10);
  ASSERT_FALSE(large);
  EXPECT_NE(large.error().find("the limit is 10"), std::string::npos);
}

}  // namespace
}  // namespace limber::model
