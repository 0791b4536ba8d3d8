// Archive: values of all supported kinds are loaded as they were saved.
#include "base/memory/archive.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace limber {
namespace {

struct Plain {
  int a = 0;
  double b = 0;
  bool operator==(const Plain&) const = default;
};

// Trivially copyable, but saves only one of its fields.
struct Selective {
  int saved = 0;
  int scratch = 0;
  void serialize(Archive& archive) { archive.serialize(saved); }
};

TEST(Archive, LoadsWhatWasSaved) {
  Plain plain{1, 2};
  std::vector<Plain> list{{3, 4}, {5, 6}};
  std::string text = "text";
  Archive archive;
  archive.begin_saving();
  archive.serialize_all(plain, list, text);
  plain = {};
  list.assign(5, {});
  text.clear();
  archive.begin_loading();
  archive.serialize_all(plain, list, text);
  EXPECT_EQ(plain, (Plain{1, 2}));
  EXPECT_EQ(list, (std::vector<Plain>{{3, 4}, {5, 6}}));
  EXPECT_EQ(text, "text");
  EXPECT_EQ(archive.position(), archive.bytes().size());
}

TEST(Archive, PrefersTheTypesOwnFunction) {
  Selective value{1, 2};
  Archive archive;
  archive.begin_saving();
  archive.serialize(value);
  EXPECT_EQ(archive.bytes().size(), sizeof value.saved);
  value = {3, 4};
  archive.begin_loading();
  archive.serialize(value);
  EXPECT_EQ(value.saved, 1);
  EXPECT_EQ(value.scratch, 4);
}

}  // namespace
}  // namespace limber
