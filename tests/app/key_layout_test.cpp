// Keys by their printed letters, for the X11 layouts us, fr, de, dvorak and ru.
#include "app/view/key_layout.h"

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include <map>
#include <sstream>

namespace limber::app {
namespace {

constexpr const char* kPlaces =
    "1 2 3 4 5 6 7 8 9 0 - = Q W E R T Y U I O P [ ] A S D F G H J K L ; ' Z X C V B N M , . /";

// the texts printed at these positions; "_": none, as on dead keys
KeyLayout layout(const std::string& printed) {
  std::map<int, std::string> names;
  std::istringstream places(kPlaces);
  std::istringstream letters(printed);
  for (std::string place, letter; places >> place && letters >> letter;) names[place[0]] = letter == "_" ? "" : letter;
  return KeyLayout([&](int key) { return names[key]; });
}

const char* const kUs = "1 2 3 4 5 6 7 8 9 0 - = q w e r t y u i o p [ ] a s d f g h j k l ; ' z x c v b n m , . /";
const char* const kFr = "& é \" ' ( - è _ ç à ) = a z e r t y u i o p _ $ q s d f g h j k l m ù w x c v b n , ; : !";
const char* const kDe = "1 2 3 4 5 6 7 8 9 0 ß _ q w e r t z u i o p ü + a s d f g h j k l ö ä y x c v b n m , . -";
const char* const kDvorak = "1 2 3 4 5 6 7 8 9 0 [ ] ' , . p y f g c r l / = a o e u i d h t n s - ; q j k x b m w v z";
const char* const kRu = "1 2 3 4 5 6 7 8 9 0 - = й ц у к е н г ш щ з х ъ ф ы в а п р о л д ж э я ч с м и т ь б ю .";

TEST(KeyLayout, UsKeysKeepTheirPositions) {
  const KeyLayout us = layout(kUs);
  for (int i = 0; i < 26; i++)
    EXPECT_EQ(us.key(GLFW_KEY_A + i), static_cast<panel::GuiKey>(static_cast<int>(panel::GuiKey::a) + i));
  for (int i = 0; i < 10; i++)
    EXPECT_EQ(us.key(GLFW_KEY_0 + i), static_cast<panel::GuiKey>(static_cast<int>(panel::GuiKey::digit_0) + i));
  EXPECT_EQ(us.key(GLFW_KEY_SLASH), panel::GuiKey::slash);
  EXPECT_EQ(us.key(GLFW_KEY_SEMICOLON), panel::GuiKey::none);
  EXPECT_EQ(us.key(GLFW_KEY_F12), panel::GuiKey::f12);
  EXPECT_EQ(us.key(GLFW_KEY_SPACE), panel::GuiKey::space);
  EXPECT_EQ(us.key(GLFW_KEY_KP_ADD), panel::GuiKey::equal);
  EXPECT_EQ(us.key(GLFW_KEY_UNKNOWN), panel::GuiKey::none);
  EXPECT_TRUE(us.labels().empty());
}

TEST(KeyLayout, AzertyFollowsLettersAndKeepsDigits) {
  const KeyLayout fr = layout(kFr);
  EXPECT_EQ(fr.key(GLFW_KEY_Q), panel::GuiKey::a);
  EXPECT_EQ(fr.key(GLFW_KEY_W), panel::GuiKey::z);
  EXPECT_EQ(fr.key(GLFW_KEY_Z), panel::GuiKey::w);
  EXPECT_EQ(fr.key(GLFW_KEY_SEMICOLON), panel::GuiKey::m);
  EXPECT_EQ(fr.key(GLFW_KEY_M), panel::GuiKey::comma);
  EXPECT_EQ(fr.key(GLFW_KEY_COMMA), panel::GuiKey::none) << "it prints ;";
  EXPECT_EQ(fr.key(GLFW_KEY_6), panel::GuiKey::digit_6) << "although it prints -";
  EXPECT_EQ(fr.key(GLFW_KEY_MINUS), panel::GuiKey::minus);
  EXPECT_EQ(fr.key(GLFW_KEY_PERIOD), panel::GuiKey::period);
  EXPECT_EQ(fr.labels().at(panel::GuiKey::period), ":");
  EXPECT_EQ(fr.labels().at(panel::GuiKey::minus), ")");
  EXPECT_FALSE(fr.labels().contains(panel::GuiKey::z));
}

TEST(KeyLayout, FollowsQwertzAndDvorak) {
  const KeyLayout de = layout(kDe);
  EXPECT_EQ(de.key(GLFW_KEY_Y), panel::GuiKey::z);
  EXPECT_EQ(de.key(GLFW_KEY_Z), panel::GuiKey::y);
  EXPECT_EQ(de.key(GLFW_KEY_SLASH), panel::GuiKey::minus);
  EXPECT_EQ(de.key(GLFW_KEY_MINUS), panel::GuiKey::none);
  EXPECT_EQ(de.key(GLFW_KEY_EQUAL), panel::GuiKey::equal) << "a dead key";
  const KeyLayout dvorak = layout(kDvorak);
  EXPECT_EQ(dvorak.key(GLFW_KEY_E), panel::GuiKey::period);
  EXPECT_EQ(dvorak.key(GLFW_KEY_W), panel::GuiKey::comma);
  EXPECT_EQ(dvorak.key(GLFW_KEY_SLASH), panel::GuiKey::z);
  EXPECT_EQ(dvorak.key(GLFW_KEY_Q), panel::GuiKey::none);
}

TEST(KeyLayout, CyrillicKeysKeepTheirPositions) {
  const KeyLayout ru = layout(kRu);
  for (int i = 0; i < 26; i++)
    EXPECT_EQ(ru.key(GLFW_KEY_A + i), static_cast<panel::GuiKey>(static_cast<int>(panel::GuiKey::a) + i));
  EXPECT_EQ(ru.labels().at(panel::GuiKey::z), "я");
  EXPECT_EQ(ru.key(GLFW_KEY_SLASH), panel::GuiKey::period) << "it prints one";
  EXPECT_EQ(ru.key(GLFW_KEY_PERIOD), panel::GuiKey::none);
  EXPECT_EQ(ru.key(GLFW_KEY_COMMA), panel::GuiKey::comma);
  EXPECT_EQ(panel::key_text({panel::GuiKey::z, {true, false, false}}, ru.labels()), "Ctrl+я");
}

}  // namespace
}  // namespace limber::app
