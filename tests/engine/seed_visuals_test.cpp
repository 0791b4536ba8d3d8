// The visuals messages of ofxDabPhysics: materials of shapes and the camera, read from the store.
#include <limits>

#include "engine/rig.h"
#include "engine/seed_table.h"

namespace limber::engine::test {
namespace {

using Values = std::vector<double>;
using Kind = Outcome::Kind;

std::string path_of(const char* shape, const Address& a) {
  return fmt::format("/visuals/shape/{}/{}", shape, a.property);
}

// the names at the start of a message, and which of the shapes `ball` and `ground` they select
struct VisualForm {
  std::vector<Arg> names;
  bool ball;
  bool ground;
};

TEST(LegacyVisuals, AcceptsEveryShapeAddressInEveryForm) {
  const VisualForm forms[] = {{{}, true, true},
                              {{arg("ball")}, true, false},
                              {{arg("ground")}, false, true},
                              {{arg("b*")}, true, false},
                              {{arg("{ball,ground}")}, true, true}};
  for (const Address& a : kShapeAddresses) {
    for (std::size_t f = 0; f < std::size(forms); f++) {
      SCOPED_TRACE(fmt::format("{} form {}", legacy_address(a), f));
      Rig rig;
      const Values values = a.width == 1 ? Values{0.25} : Values{0.25, 0.5, 0.75};
      const Values ball = rig.read(path_of("ball", a));
      const Values ground = rig.read(path_of("ground", a));
      Message m{legacy_address(a), forms[f].names};
      for (const double v : values) m.args.push_back(arg(v));
      const Outcome outcome = rig.dispatcher.execute(m);
      EXPECT_EQ(outcome.kind, Kind::applied) << outcome.error;
      EXPECT_TRUE(outcome.sets_override);
      EXPECT_EQ(rig.read(path_of("ball", a)), forms[f].ball ? values : ball);
      EXPECT_EQ(rig.read(path_of("ground", a)), forms[f].ground ? values : ground);
    }
  }
}

TEST(LegacyVisuals, InvalidMessagesAreRejectedAsAWhole) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Address& a : kShapeAddresses) {
    SCOPED_TRACE(a.address);
    Rig rig;
    const Values before = rig.everything();
    const auto expect_rejected = [&](std::vector<Arg> args, const char* why) {
      rig.dispatcher.begin_pass();
      const Outcome outcome = rig.dispatcher.execute({legacy_address(a), std::move(args)});
      EXPECT_EQ(outcome.kind, Kind::rejected);
      EXPECT_NE(outcome.error.find(why), std::string::npos) << outcome.error;
    };
    std::vector<Arg> value(a.width, arg(0.5));
    const auto with = [&](std::vector<Arg> in_front, std::size_t values) {
      in_front.insert(in_front.end(), values, arg(0.5));
      return in_front;
    };
    expect_rejected(with({arg("bal")}, a.width), "did you mean 'ball'?");
    expect_rejected(with({arg("x*")}, a.width), "no shape matches 'x*'");
    expect_rejected(with({arg("ball"), arg("x")}, a.width), "2 names");
    expect_rejected({}, "number");
    expect_rejected({arg("ball")}, "number");
    if (a.width == 3) expect_rejected(with({arg("ball")}, 2), "3 numbers");
    value.back() = arg(nan);
    expect_rejected(value, "is not finite");
    EXPECT_EQ(rig.everything(), before);
  }
}

TEST(LegacyVisuals, SetsTheCamera) {
  Rig rig;
  EXPECT_EQ(rig.send("/visuals/camera/position", 0, -4, -3.9).kind, Kind::applied);
  EXPECT_EQ(rig.send("/visuals/camera/rotation", -80, 0, -24).kind, Kind::applied);
  EXPECT_EQ(rig.send("/visuals/camera/projection", 65.9, 0, 0.1, 200).kind, Kind::applied);
  EXPECT_EQ(rig.read("/visuals/camera/position"), (Values{0, -4, -3.9}));
  EXPECT_EQ(rig.read("/visuals/camera/rotation"), (Values{-80, 0, -24}));
  EXPECT_EQ(rig.read("/visuals/camera/fovy"), Values{65.9});
  EXPECT_EQ(rig.read("/visuals/camera/aspect"), Values{0});
  EXPECT_EQ(rig.read("/visuals/camera/near"), Values{0.1});
  EXPECT_EQ(rig.read("/visuals/camera/far"), Values{200});
  EXPECT_EQ(rig.send("/visuals/camera/projection", "40", true, 0.5, 100).kind, Kind::applied)
      << "accepts the same notations as others";
  EXPECT_EQ(rig.read("/visuals/camera/fovy"), Values{40});
  const Values before = rig.everything();
  for (const Outcome& outcome :
       {rig.send("/visuals/camera/projection", 40, 1, 10, 10), rig.send("/visuals/camera/projection", 40, 1, 0.1),
        rig.send("/visuals/camera/projection", "wide", 1, 0.1, 100), rig.send("/visuals/camera/projection"),
        rig.send("/visuals/camera/position", 1, 2), rig.send("/visuals/camera/rotation", "arm", 1, 2, 3)}) {
    EXPECT_EQ(outcome.kind, Kind::rejected);
    EXPECT_FALSE(outcome.error.empty());
  }
  EXPECT_EQ(rig.everything(), before);
  // out of range: each is clamped on its own
  const Outcome clamped = rig.send("/visuals/camera/projection", 500, 1, 0.1, 100);
  EXPECT_EQ(clamped.kind, Kind::applied);
  EXPECT_NE(clamped.clamped, nullptr);
  EXPECT_EQ(rig.read("/visuals/camera/fovy"), Values{170});
}

TEST(LegacyVisuals, SuggestsSimilarAddressesAndShapes) {
  Rig rig;
  EXPECT_NE(rig.send("/visuals/shape/transparancy", 0.5).error.find("did you mean '/visuals/shape/transparency'?"),
            std::string::npos);
  EXPECT_NE(rig.send("/visuals/shape/bal/transparency", 0.5).error.find("did you mean 'ball'?"), std::string::npos);
  EXPECT_EQ(rig.send("/visuals/shape/*/specular_pow", 20).kind, Kind::applied);
  EXPECT_EQ(rig.read("/visuals/shape/ground/specular_pow"), Values{20});
  EXPECT_EQ(rig.send("/visuals/background", 0.5, 1, 0.25).kind, Kind::applied);
  EXPECT_EQ(rig.read("/visuals/background"), (Values{0.5, 1, 0.25}));
}

}  // namespace
}  // namespace limber::engine::test
