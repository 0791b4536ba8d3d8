// The window of `limber breed` without a window: clicks, keys, and what is drawn.
#include "ui/panel/breed/breed_gui.h"

#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace limber::panel::test {
namespace {

using Kind = BreedAction::Kind;

class BreedFixture {
 public:
  BreedFixture() : gui_(options()) {
    view.parameters = {{"rate", false}, {"depth", true}, {"a ## b", false}};
    for (BreedCell& cell : view.cells) {
      cell.values = {"1", "0.5", "walk"};
      cell.positions = {0.1, 0.5, 1};
    }
    frames(3);
  }

  void frame() {
    clock_ += 1.0 / 60;
    for (BreedAction& action : gui_.frame({width, height, 1, clock_}, 16, view)) actions.push_back(action);
  }
  void frames(int count) {
    for (int i = 0; i < count; i++) frame();
    while (gui_.has_events()) frame();
  }
  PanelRect rect_of(const std::string& name) {
    const NamedWidget* const widget = gui_.names().find(name);
    if (widget == nullptr || widget->visible.empty()) {
      ADD_FAILURE() << "there is no widget '" << name << "' to be seen";
      return {};
    }
    return widget->visible;
  }
  void move(const std::string& name, double part_x = 0.5, double part_y = 0.5) {
    const PanelRect at = rect_of(name);
    InputEvent event;
    event.x = at.x + part_x * at.width;
    event.y = at.y + part_y * at.height;
    gui_.push(event);
    frames(2);
  }
  void button(bool down) {
    InputEvent event;
    event.kind = InputEvent::Kind::button;
    event.down = down;
    gui_.push(event);
    frames(2);
  }
  /// Returns the kinds of the actions after a click.
  std::vector<Kind> click(const std::string& name) {
    actions.clear();
    move(name);
    button(true);
    button(false);
    return kinds();
  }
  std::vector<Kind> press(GuiKey key, KeyMods mods = {}) {
    actions.clear();
    InputEvent event;
    event.kind = InputEvent::Kind::key;
    event.key = key;
    event.mods = mods;
    event.down = true;
    gui_.push(event);
    event.down = false;
    gui_.push(event);
    event = {};
    event.kind = InputEvent::Kind::key;
    gui_.push(event);
    frames(2);
    return kinds();
  }
  std::vector<Kind> kinds() const {
    std::vector<Kind> all;
    for (const BreedAction& action : actions) all.push_back(action.kind);
    return all;
  }
  BreedGui& gui() { return gui_; }

  BreedView view;
  std::vector<BreedAction> actions;
  double width = 1280, height = 720;

 private:
  static GuiHostOptions options() {
    GuiHostOptions options;
    options.draws = false;
    return options;
  }
  BreedGui gui_;
  double clock_ = 0;
};

TEST(BreedGui, CellsDoNotOverlapAndFillTheWindow) {
  BreedFixture breed;
  for (const auto& [width, height] : {std::pair(1280.0, 720.0), {640.0, 360.0}, {3840.0, 2160.0}}) {
    breed.width = width;
    breed.height = height;
    breed.frames(3);
    double area = 0;
    std::set<std::pair<double, double>> corners;
    for (int i = 1; i <= 9; i++) {
      const PanelRect cell = breed.rect_of("cell:" + std::to_string(i));
      corners.emplace(cell.x, cell.y);
      area += cell.width * cell.height;
      EXPECT_LE(cell.x + cell.width, breed.rect_of("breed.mutate").x);
    }
    EXPECT_EQ(corners.size(), 9u);
    EXPECT_GT(area, 0.5 * width * height);
    EXPECT_EQ(breed.gui().cell_width(), static_cast<int>(breed.rect_of("cell:1").width));
  }
}

TEST(BreedGui, AClickLikesAndADragMovesTheCameras) {
  BreedFixture breed;
  ASSERT_EQ(breed.click("cell:5"), std::vector<Kind>{Kind::like});
  EXPECT_EQ(breed.actions[0].index, 4u);
  EXPECT_TRUE(breed.gui().moves_camera());
  breed.actions.clear();
  breed.move("cell:2");
  breed.button(true);
  breed.move("cell:2", 0.7);
  EXPECT_TRUE(breed.gui().moves_camera());
  breed.move("cell:2");  // back to where it began
  breed.button(false);
  EXPECT_TRUE(breed.actions.empty());
  breed.move("breed.mutate");
  EXPECT_FALSE(breed.gui().moves_camera());
}

TEST(BreedGui, ButtonsAndKeysAct) {
  BreedFixture breed;
  breed.view.can_undo = breed.view.can_redo = true;
  breed.view.cells[3].liked = true;
  breed.frames(2);
  EXPECT_EQ(breed.click("breed.mutate"), std::vector<Kind>{Kind::mutate});
  EXPECT_NEAR(breed.actions[0].amount, 0.1, 1e-6);
  EXPECT_EQ(breed.click("breed.cross"), std::vector<Kind>{Kind::cross});
  EXPECT_EQ(breed.click("breed.random"), std::vector<Kind>{Kind::randomize});
  EXPECT_EQ(breed.click("breed.undo"), std::vector<Kind>{Kind::undo});
  EXPECT_EQ(breed.click("breed.redo"), std::vector<Kind>{Kind::redo});
  EXPECT_EQ(breed.click("breed.pause"), std::vector<Kind>{Kind::pause});
  EXPECT_EQ(breed.click("breed.restart"), std::vector<Kind>{Kind::restart});
  EXPECT_EQ(breed.click("breed.follow"), std::vector<Kind>{Kind::follow});
  EXPECT_EQ(breed.press(GuiKey::f), std::vector<Kind>{Kind::follow});
  EXPECT_EQ(breed.click("breed.keep"), std::vector<Kind>{Kind::keep});
  EXPECT_EQ(breed.actions[0].name, "bred");
  EXPECT_EQ(breed.click("hold:depth"), std::vector<Kind>{Kind::hold});
  EXPECT_EQ(breed.actions[0].index, 1u);
  EXPECT_EQ(breed.press(GuiKey::m), std::vector<Kind>{Kind::mutate});
  EXPECT_EQ(breed.press(GuiKey::c), std::vector<Kind>{Kind::cross});
  EXPECT_EQ(breed.press(GuiKey::r), std::vector<Kind>{Kind::randomize});
  EXPECT_EQ(breed.press(GuiKey::k), std::vector<Kind>{Kind::keep});
  EXPECT_EQ(breed.press(GuiKey::z, {true, false, false}), std::vector<Kind>{Kind::undo});
  EXPECT_EQ(breed.press(GuiKey::y, {true, false, false}), std::vector<Kind>{Kind::redo});
  EXPECT_EQ(breed.press(GuiKey::z, {true, true, false}), std::vector<Kind>{Kind::redo});
  EXPECT_EQ(breed.press(GuiKey::space), std::vector<Kind>{Kind::pause});
  EXPECT_EQ(breed.press(GuiKey::home), std::vector<Kind>{Kind::restart});
  EXPECT_EQ(breed.press(GuiKey::f11), std::vector<Kind>{Kind::full_screen});
  EXPECT_EQ(breed.press(GuiKey::digit_9), std::vector<Kind>{Kind::like});
  EXPECT_EQ(breed.actions[0].index, 8u);
}

TEST(BreedGui, HomeAndSpaceDoNotMoveTheKeyboardFocus) {
  BreedFixture breed;
  breed.click("breed.mutate");
  EXPECT_EQ(breed.press(GuiKey::home), std::vector<Kind>{Kind::restart});
  EXPECT_EQ(breed.press(GuiKey::home), std::vector<Kind>{Kind::restart});
  EXPECT_EQ(breed.press(GuiKey::space), std::vector<Kind>{Kind::pause});
  EXPECT_EQ(breed.press(GuiKey::m), std::vector<Kind>{Kind::mutate});
}

TEST(BreedGui, SpacePressesTheSelectedButton) {
  BreedFixture breed;
  breed.click("breed.mutate");
  breed.press(GuiKey::right);
  breed.press(GuiKey::left);
  EXPECT_EQ(breed.press(GuiKey::space), std::vector<Kind>{Kind::mutate});
}

TEST(BreedGui, ButtonsThatHaveNoEffectAreDisabled) {
  BreedFixture breed;
  EXPECT_TRUE(breed.click("breed.keep").empty());
  EXPECT_TRUE(breed.click("breed.undo").empty());
  EXPECT_TRUE(breed.click("breed.redo").empty());
  // in one frame both keys arrive before the view shows what the first one likes
  InputEvent event;
  event.kind = InputEvent::Kind::key;
  for (const GuiKey key : {GuiKey::digit_2, GuiKey::k}) {
    event.key = key;
    for (const bool down : {true, false}) {
      event.down = down;
      breed.gui().push(event);
    }
  }
  breed.frames(2);
  EXPECT_EQ(breed.kinds(), (std::vector<Kind>{Kind::like, Kind::keep}));
}

TEST(BreedGui, KeysWriteTheNameWhileItIsEdited) {
  BreedFixture breed;
  breed.view.cells[0].liked = true;
  breed.click("breed.name");
  EXPECT_TRUE(breed.press(GuiKey::a, {true, false, false}).empty());
  for (const char c : std::string("mk")) {
    InputEvent event;
    event.kind = InputEvent::Kind::text;
    event.character = static_cast<unsigned char>(c);
    breed.gui().push(event);
    breed.frames(2);
  }
  EXPECT_TRUE(breed.press(GuiKey::m).empty());
  EXPECT_EQ(breed.click("breed.keep"), std::vector<Kind>{Kind::keep});
  EXPECT_EQ(breed.actions[0].name, "mk");
}

TEST(BreedGui, ShowsErrorsAndManyParameters) {
  BreedFixture breed;
  breed.view.notice = "disk full";
  breed.view.failed = true;
  for (int i = 0; i < 300; i++) breed.view.parameters.push_back({"p" + std::to_string(i), false});
  for (BreedCell& cell : breed.view.cells) {
    cell.error = std::string(2000, 'x') + " ## y";
    cell.preset = "a ## b";
  }
  for (const double width : {1280.0, 200.0, 1.0}) {
    breed.width = breed.height = width;
    breed.frames(3);
  }
  breed.width = 1280;
  breed.height = 720;
  breed.frames(3);
  EXPECT_FALSE(breed.rect_of("breed.notice").empty());
}

}  // namespace
}  // namespace limber::panel::test
