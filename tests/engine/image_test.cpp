// Images: they hold every value of their moment, are made when asked for and not too often, and tell who set what.
#include "engine/image.h"

#include <gtest/gtest.h>

#include "engine/everything.h"
#include "engine/feed.h"
#include "engine/image_maker.h"
#include "engine/image_of.h"
#include "engine/show.h"

namespace limber::engine_test {
namespace {

TEST(Image, HoldsEveryValueOfTheStore) {
  const SceneFile scene(kEverything);
  Show show(scene.path());
  show.ticks(20);
  const std::shared_ptr<const Image> image = image_of(show);
  const Store& store = show.engine.store();
  std::size_t rows = 0;
  for (std::uint32_t i = 0; i < image->tree->nodes().size(); i++) {
    const Tree::Node& node = image->tree->nodes()[i];
    for (const Row& row : node.table->rows()) {
      const double* const values = image->value(image->tree->numbers({i, &row})).numbers;
      if (row.kind == RowKind::action) {
        EXPECT_EQ(values, nullptr);
        continue;
      }
      double expected[4] = {};
      store.get(node.id, row, expected);
      for (std::uint32_t k = 0; k < row.width; k++) EXPECT_EQ(values[k], expected[k]) << image->tree->path({i, &row});
      rows++;
    }
  }
  EXPECT_GT(rows, 500u);
  EXPECT_EQ(image->snapshot->tick, show.engine.world().tick());
}

TEST(Image, IsMadeOnlyWhenAskedFor) {
  Show show;
  show.ticks(5);
  EXPECT_EQ(show.link.images.read(), nullptr);
  const std::uint64_t first = show.link.ask_image();
  const std::uint64_t second = show.link.ask_image();
  show.ticks(1);
  const auto image = show.link.images.read();
  ASSERT_NE(image, nullptr);
  EXPECT_EQ(second, first + 1);
  EXPECT_EQ(image->asks, second) << "one image answers all who asked before";
  show.ticks(5);
  EXPECT_EQ(show.link.images.read()->number, 1u);
}

TEST(Image, HoldsWhatWasSentBeforeItWasAskedFor) {
  const SceneFile scene(kEverything);
  Show show(scene.path());
  for (int i = 1; i <= 10; i++) {
    show.send("/scene/wind", 0.5 * i);
    const auto image = image_of(show);
    EXPECT_EQ(image->value(image->tree->numbers(*image->tree->find("/scene/wind"))).numbers[0], 0.5 * i);
  }
}

TEST(Image, TheTreeIsMadeAnewOnlyWhenSomethingCameOrWent) {
  const SceneFile scene(kEverything);
  Show show(scene.path());
  show.ticks(20);
  show.send("/transport/pause");
  const auto first = image_of(show);
  show.ticks(3);
  const auto second = image_of(show);
  EXPECT_EQ(second->tree, first->tree);
  EXPECT_GT(second->number, first->number);
  ASSERT_TRUE(show.engine.world().add_body("new").ok());
  EXPECT_TRUE(image_of(show)->tree->find("/physics/body/new").ok());
  EXPECT_FALSE(first->tree->find("/physics/body/new").ok());
  // a reset is another store, whatever its counters say
  show.send("/transport/reset");
  const auto after = image_of(show);
  EXPECT_FALSE(after->tree->find("/physics/body/new").ok());
  EXPECT_GT(after->number, second->number);
  EXPECT_GE(second->snapshot->tick, 20u);
  EXPECT_EQ(after->value(after->tree->numbers(*after->tree->find("/physics/sim/tick"))).numbers[0], 0);
}

// a thing that says something of itself
struct Voice {
  std::string words;
  std::string_view read_words() const { return words; }
};
const Table& voice_table() {
  static const Table table("voice", "/voice", "",
                           {rows::number("before", "", 0, 0, 1, "A number."),
                            rows::say<&Voice::read_words>(rows::text("words", "What it says.")),
                            rows::say<&Voice::read_words>(rows::text("again", "And again."))});
  return table;
}

TEST(ImageMaker, TextsAreTold) {
  Voice one{"first"};
  Voice two{"second"};
  Store store;
  store.add(voice_table(), store.root(), "one", &one);
  store.add(voice_table(), store.root(), "two", &two);
  Latest<Image> out;
  ImageMaker maker(out);
  Feed feed;
  std::vector<std::string> told;
  feed.add("/two/again");
  const auto tell = [&] {
    feed.hear(out.read(), {});
    feed.tell([&](const std::string& path, const Row&, const RowValue& value) {
      told.push_back(path + " " + std::string(value.text));
      return true;
    });
  };
  ASSERT_TRUE(maker.make(store, std::make_shared<Snapshot>(), 1));
  const auto image = out.read();
  EXPECT_EQ(image->value(image->tree->numbers(*image->tree->find("/one/words"))).text, "first");
  EXPECT_EQ(image->value(image->tree->numbers(*image->tree->find("/two/again"))).text, "second");
  tell();
  tell();
  two.words = "third";
  for (std::uint64_t ask = 2; out.read() == image; ask++) maker.make(store, std::make_shared<Snapshot>(), ask);
  EXPECT_EQ(image->value(image->tree->numbers(*image->tree->find("/two/again"))).text, "second") << "as it was";
  tell();
  EXPECT_EQ(told, (std::vector<std::string>{"/two/again second", "/two/again third"}));
}

// a clock that each look at it advances by so much
double turned = 0;
double turn = 0;
double turned_clock() { return turned += turn; }
// by which an image costs 2 ms
double spent = 0;
double spent_clock() { return spent += 0.002; }

TEST(ImageMaker, TakesAHundredthOfTheTime) {
  Rig rig;
  Latest<Image> out;
  turned = 0;
  turn = 0.002;
  ImageMaker maker(out, &turned_clock, &spent_clock);
  const auto snapshot = std::make_shared<Snapshot>();
  std::uint64_t made = 0;
  // 10 s of looks: at most every 200 ms
  for (std::uint64_t ask = 1; turned < 10; ask++) made += maker.make(rig.store, snapshot, ask) ? 1 : 0;
  EXPECT_GE(made, 49u);
  EXPECT_LE(made, 51u);
}

TEST(ImageMaker, ASuspendedProgramOwesNothing) {
  Rig rig;
  Latest<Image> out;
  ImageMaker maker(out, &turned_clock, &spent_clock);
  const auto snapshot = std::make_shared<Snapshot>();
  turned = 0;
  turn = 1000;  // so long the first image takes
  ASSERT_TRUE(maker.make(rig.store, snapshot, 1));
  turn = 0.002;
  int looks = 1;
  while (looks < 1000 && !maker.make(rig.store, snapshot, 2)) looks++;
  EXPECT_NEAR(looks, 99, 1) << "the next one is due after 198 ms";
}

TEST(ImageMaker, NotesAreNewestLastAndDoNotStayForEver) {
  Rig rig;
  Latest<Image> out;
  turn = 0;
  ImageMaker maker(out, &turned_clock, &turned_clock);
  const auto snapshot = std::make_shared<Snapshot>();
  const Origin one{Hand::osc, 1, 1, true};
  const Place friction = *find_place(rig.store, "/physics/body/arm/part/tip/friction");
  const Place mass = *find_place(rig.store, "/physics/body/arm/part/tip/mass");
  for (const double value : {0.25, 0.75}) {
    ASSERT_TRUE(rig.store.set(friction.node, *friction.row, {&value, 1}).ok());
    maker.note(rig.store, one, friction, false);
  }
  maker.note(rig.store, one, mass, true);
  std::uint64_t ask = 0;
  ASSERT_TRUE(maker.make(rig.store, snapshot, ++ask));
  const auto& notes = out.read()->notes;
  ASSERT_EQ(notes.size(), 2u) << "a place that is set twice is noted once";
  EXPECT_EQ(notes[0].row, friction.row);
  EXPECT_EQ(notes[0].values[0], 0.75);
  EXPECT_FALSE(notes[0].clamped);
  EXPECT_TRUE(notes[1].clamped);
  EXPECT_LT(notes[0].number, notes[1].number);
  for (std::uint64_t i = 1; i < ImageMaker::kNoteLasts; i++) ASSERT_TRUE(maker.make(rig.store, snapshot, ++ask));
  EXPECT_EQ(out.read()->notes.size(), 2u);
  ASSERT_TRUE(maker.make(rig.store, snapshot, ++ask));
  EXPECT_TRUE(out.read()->notes.empty());
  // bounded, the newest kept
  for (std::uint32_t i = 0; i < 3 * ImageMaker::kMostNotes; i++)
    maker.note(rig.store, {Hand::osc, 1, static_cast<std::uint16_t>(i), true}, friction, false);
  ASSERT_TRUE(maker.make(rig.store, snapshot, ++ask));
  EXPECT_LE(out.read()->notes.size(), ImageMaker::kMostNotes);
  EXPECT_EQ(out.read()->notes.back().origin.port, 3 * ImageMaker::kMostNotes - 1);
}

TEST(Image, OnlyHandsThatFollowAreNoted) {
  const SceneFile scene(kEverything);
  Show show(scene.path());
  const auto send = [&](bool follows, double wind) {
    show.link.inbox.push({{message("/scene/wind", wind)}, {Hand::osc, 7, 7, follows}});
  };
  send(false, 1);
  EXPECT_TRUE(image_of(show)->notes.empty());
  send(true, 20);  // its range ends at 10
  const auto image = image_of(show);
  ASSERT_EQ(image->notes.size(), 1u);
  EXPECT_EQ(image->notes[0].values[0], 10);
  EXPECT_TRUE(image->notes[0].clamped);
  EXPECT_EQ(image->notes[0].origin, (Origin{Hand::osc, 7, 7, false})) << "following is no part of who one is";
}

}  // namespace
}  // namespace limber::engine_test
