// Messages besides the legacy forms: one number for three axes, paths and patterns, rejections, queries.
#include "engine/commands/message_dispatcher.h"

#include <limits>

#include "engine/rig.h"

namespace limber::engine::test {
namespace {

using Values = std::vector<double>;
using Kind = Outcome::Kind;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

std::string motor(const char* body, const char* joint, const char* property) {
  return fmt::format("/physics/body/{}/motor/{}/{}", body, joint, property);
}

TEST(MessageDispatcher, OneNumberSetsTheOwnAxis) {
  Rig rig;
  // z is the own axis of a revolute joint: the others keep their values; the slide has no angular axis of its own
  ASSERT_EQ(rig.send("/physics/motor/angularvelocity", "arm", "elbow", 1, 2, 3).kind, Kind::applied);
  EXPECT_EQ(rig.send("/physics/motor/angularvelocity", 0.5).kind, Kind::applied);
  EXPECT_EQ(rig.read(motor("arm", "elbow", "angular_velocity")), (Values{1, 2, 0.5}));
  EXPECT_EQ(rig.read(motor("1", "shoulder", "angular_velocity")), (Values{0, 0, 0.5}));
  EXPECT_EQ(rig.read(motor("arm", "slide", "angular_velocity")), (Values{0, 0, 0}));
  EXPECT_EQ(rig.send("/physics/motor/linearvelocity", "arm", 0.75).kind, Kind::applied);
  EXPECT_EQ(rig.read(motor("arm", "slide", "linear_velocity")), (Values{0, 0, 0.75}));
  EXPECT_EQ(rig.read(motor("arm", "elbow", "linear_velocity")), (Values{0, 0, 0}));
  EXPECT_EQ(rig.send("/physics/joint/angularupperlimit", "elbow", 1.5).kind, Kind::applied);
  EXPECT_EQ(rig.read("/physics/body/arm/joint/elbow/angular_upper_limit")[2], 1.5);
  EXPECT_EQ(rig.send("/physics/body/arm/motor/elbow/angular_spring_stiffness", 20).kind, Kind::applied);
  EXPECT_EQ(rig.read(motor("arm", "elbow", "angular_spring_stiffness")), (Values{0, 0, 20}));
}

TEST(MessageDispatcher, OneNumberWithoutAnOwnAxisIsRejected) {
  Rig rig;
  const std::vector<double> before = rig.everything();
  const Outcome by_name = rig.send("/physics/motor/angularvelocity", "arm", "slide", 1);
  EXPECT_EQ(by_name.kind, Kind::rejected);
  EXPECT_EQ(by_name.error, "motor 'arm/slide': has no own axis for angular_velocity; give three numbers");
  EXPECT_EQ(rig.send(motor("arm", "slide", "angular_velocity"), 1).kind, Kind::rejected);
  // a body without any is an error with a reason too
  EXPECT_EQ(rig.send("/physics/motor/linearvelocity", "1", 1).kind, Kind::rejected);
  EXPECT_EQ(rig.everything(), before);
}

TEST(MessageDispatcher, OneBooleanSetsAllAxes) {
  Rig rig;
  for (const Arg& on : {arg(true), arg(1), arg(0.5), arg("true"), arg("on"), arg("1")}) {
    rig.send("/physics/motor/angularspringactive", 0, 0, 0);
    EXPECT_EQ(rig.send("/physics/motor/angularspringactive", "arm", "slide", on).kind, Kind::applied);
    EXPECT_EQ(rig.read(motor("arm", "slide", "angular_spring_active")), (Values{1, 1, 1}));
    EXPECT_EQ(rig.read(motor("arm", "elbow", "angular_spring_active")), (Values{0, 0, 0}));
  }
  for (const Arg& off : {arg(false), arg(0), arg(0.49), arg("False"), arg("off")}) {
    rig.send("/physics/motor/angularspringactive", true);
    EXPECT_EQ(rig.send("/physics/motor/angularspringactive", off).kind, Kind::applied);
    EXPECT_EQ(rig.read(motor("1", "shoulder", "angular_spring_active")), (Values{0, 0, 0}));
  }
}

TEST(MessageDispatcher, AcceptsChoicesByLabelAndByNumber) {
  Rig rig;
  EXPECT_EQ(rig.send("/physics/motor/mode", "arm", "elbow", "SPRING").kind, Kind::applied);
  EXPECT_EQ(rig.read(motor("arm", "elbow", "mode")), (Values{3}));
  EXPECT_EQ(rig.read(motor("arm", "elbow", "angular_spring_active")), (Values{0, 0, 1}));
  EXPECT_EQ(rig.send(motor("arm", "elbow", "mode"), 1).kind, Kind::applied);
  EXPECT_EQ(rig.read(motor("arm", "elbow", "mode")), (Values{1}));
  const Outcome word = rig.send("/physics/motor/mode", "arm", "elbow", "sprung");
  EXPECT_EQ(word.kind, Kind::rejected);
  EXPECT_EQ(word.error, "takes one of off, spin, servo, spring, torque, not 'sprung'");
  EXPECT_EQ(rig.send(motor("arm", "elbow", "mode"), 5).kind, Kind::rejected);
  EXPECT_EQ(rig.read(motor("arm", "elbow", "mode")), (Values{1}));
}

TEST(MessageDispatcher, SettingAComputedPropertyIsAnOverride) {
  Rig rig;
  EXPECT_TRUE(rig.send("/physics/motor/target", 0.5).sets_override)
      << "it sets the servo's position, a persistent property";
  EXPECT_FALSE(rig.send("/physics/body/arm/position", 0, 0, 3).sets_override) << "a pose is a state";
  EXPECT_FALSE(rig.send("/physics/sim/paused", true).sets_override);
  EXPECT_TRUE(rig.send("/physics/sim/gravity", 0).sets_override);
}

TEST(MessageDispatcher, MassSkipsStaticParts) {
  Rig rig;
  EXPECT_EQ(rig.send("/physics/part/mass", 2).kind, Kind::applied);
  EXPECT_EQ(rig.read("/physics/body/arm/part/base/mass"), (Values{0}));
  EXPECT_EQ(rig.read("/physics/body/floor/part/floor/mass"), (Values{0}));
  EXPECT_EQ(rig.read("/physics/body/arm/part/tip/mass"), (Values{2}));
  for (const Outcome& outcome :
       {rig.send("/physics/part/mass", "arm", "base", 1), rig.send("/physics/body/arm/part/base/mass", 1),
        rig.send("/physics/part/mass", "floor", 1), rig.send("/physics/part/mass", "base", 1)}) {
    EXPECT_EQ(outcome.kind, Kind::rejected);
    EXPECT_NE(outcome.error.find("mass 0"), std::string::npos) << outcome.error;
  }
  EXPECT_EQ(rig.read("/physics/body/arm/part/base/mass"), (Values{0}));
}

TEST(MessageDispatcher, AcceptsPathsWithPatterns) {
  struct Case {
    const char* path;
    std::vector<std::string> hits;
  };
  const Case cases[] = {
      {"/physics/body/*/part/tip/friction", {"arm/part/tip", "1/part/tip"}},
      {"/physics/body/arm/part/{upper,lower}/friction", {"arm/part/upper", "arm/part/lower"}},
      {"/physics/body/a?m/part/[t-u]*/friction", {"arm/part/upper", "arm/part/tip"}},
      {"/physics/body/[!a]*/part/*/friction", {"1/part/base", "1/part/tip", "floor/part/floor"}},
      {"//tip/friction", {"arm/part/tip", "1/part/tip"}},
      {"/physics//part/base/friction", {"arm/part/base", "1/part/base"}},
      {"/physics/body/arm/part/tip/frict?on", {"arm/part/tip"}},
      {"/physics/body/arm/part/tip/FRICTION", {"arm/part/tip"}},
  };
  for (const Case& c : cases) {
    Rig rig;
    EXPECT_EQ(rig.send(c.path, 0.125).kind, Kind::applied) << c.path;
    int hits = 0;
    for (const auto& body : rig.world.bodies()) {
      for (const auto& part : body->parts())
        hits += rig.read(fmt::format("{}/friction", rig.store.path(part->id())))[0] == 0.125;
    }
    EXPECT_EQ(hits, static_cast<int>(c.hits.size())) << c.path;
    for (const std::string& hit : c.hits)
      EXPECT_EQ(rig.read("/physics/body/" + hit + "/friction"), (Values{0.125})) << c.path << " " << hit;
  }
}

TEST(MessageDispatcher, UnescapesNamesInPaths) {
  Rig rig;
  sim::Body& body = **rig.world.add_body("left arm #1/2");
  ASSERT_TRUE(body.add_part("50%", *rig.world.shapes().find("ball"), 1, {}).ok());
  EXPECT_EQ(rig.send("/physics/body/left%20arm%20%231%2f2/part/50%25/friction", 0.25).kind, Kind::applied);
  EXPECT_EQ(rig.send("/physics/part/restitution", "left arm #1/2", "50%", 0.75).kind, Kind::applied);
  const std::string path = "/physics/body/left%20arm%20%231%2F2/part/50%25";
  EXPECT_EQ(rig.store.path(body.parts()[0]->id()), path);
  EXPECT_EQ(rig.read(path + "/friction"), (Values{0.25}));
  EXPECT_EQ(rig.read(path + "/restitution"), (Values{0.75}));
}

TEST(MessageDispatcher, FindsAPathAgainAfterItsObjectWasAddedAgain) {
  Rig rig;
  const std::string path = "/physics/body/arm/part/tip/friction";
  EXPECT_EQ(rig.send(path, 0.25).kind, Kind::applied);
  EXPECT_EQ(rig.send("/physics/body/arm/remove").kind, Kind::applied);
  EXPECT_EQ(rig.world.find_body("arm"), nullptr);
  EXPECT_EQ(rig.send(path, 0.5).kind, Kind::unknown);
  sim::Body& again = **rig.world.add_body("arm");
  ASSERT_TRUE(again.add_part("tip", *rig.world.shapes().find("ball"), 1, {}).ok());
  EXPECT_EQ(rig.send(path, 0.75).kind, Kind::applied);
  EXPECT_EQ(rig.read(path), (Values{0.75}));
}

TEST(MessageDispatcher, RejectedMessagesChangeNothingAndNameTheAlternatives) {
  struct Case {
    Message message;
    Kind kind;
    const char* expected_error;
  };
  const Arg nothing;
  const Case cases[] = {
      {message("/physics/part/mass", "arn", 1), Kind::rejected, "there is no body or part 'arn'; did you mean 'arm'?"},
      {message("/physics/part/mass", "arm", "tipp", 1), Kind::rejected, "no part 'tipp' in 'arm'; did you mean 'tip'?"},
      {message("/physics/part/mass", "arn", "tip", 1), Kind::rejected, "there is no body 'arn'; did you mean 'arm'?"},
      {message("/physics/motor/bounce", "floor", 1), Kind::rejected, "body 'floor' has no motors"},
      {message("/physics/motor/bounce", "x*", 1), Kind::rejected, "no body and no motor matches 'x*'"},
      {message("/physics/motor/bounce", "arm", "x*", 1), Kind::rejected, "no motor matches 'x*' in 'arm'"},
      {message("/physics/part/mass"), Kind::rejected, "takes 1 number, not 0"},
      {message("/physics/part/mass", "arm"), Kind::rejected, "takes 1 number, not 0"},
      {message("/physics/part/mass", 1, 2, 3, 4), Kind::rejected, "takes 1 number, not 4"},
      {message("/physics/part/mass", 7, 1), Kind::rejected, "takes 1 number, not 2"},
      {message("/physics/part/mass", "a", "b", "c", 1), Kind::rejected,
       "takes a body, a part and 1 number, got 3 names"},
      {message("/physics/part/mass", nothing, 1), Kind::rejected, "a name is missing: the argument is nil"},
      {message("/physics/part/mass", "arm", "tip", kNan), Kind::rejected, "takes 1 number; nan is not finite"},
      {message("/physics/part/mass", kInf), Kind::rejected, "takes 1 number; inf is not finite"},
      {message("/physics/part/mass", "arm", "tip", "heavy"), Kind::rejected, "takes 1 number, not 0"},
      {message("/physics/joint/angularlowerlimit", "arm", "elbow", 1, 2), Kind::rejected,
       "takes 1 or 3 numbers, not 2"},
      {message("/physics/joint/angularlowerlimit", 1, kNan, 3), Kind::rejected, "nan is not finite"},
      {message("/physics/body/arm/part/tip/mass", "x"), Kind::rejected, "takes 1 number, not 'x'"},
      {message("/physics/body/arm/part/tip/mass", nothing), Kind::rejected, "not an argument without a value"},
      {message("/physics/body/arm/part/tip/mass", 1, 2), Kind::rejected, "takes 1 number, not 2"},
      {message("/physics/body/arm/part/tip/center", 1, 2, 3), Kind::rejected, "this property is read-only"},
      {message("/physics/body/arm/part/tip/rotation", 0, 0, 0, 0), Kind::rejected, "0 0 0 0 is not a rotation"},
      {message("/physics/body/arm/part/tip", 1), Kind::rejected, "this is an object, not a property"},
      {message("/physics/body/arm/part/tip/*", 1), Kind::rejected, "takes 3 numbers, not 1"},
      {message("/physics/body/arm/part/tip/{mass,apply_torque}", 1), Kind::rejected,
       "this matches both values and the action apply_torque"},
      {message("/physics/body/q*/part/*/mass", 1), Kind::rejected, "this pattern matches nothing that can be set"},
      {message("/physics/body/arm/part/tip/maas", 1), Kind::unknown, "did you mean 'mass'?"},
      {message("/physics/body/arn/part/tip/mass", 1), Kind::unknown, "did you mean 'arm'?"},
      {message("/physics/part/masss", 1), Kind::unknown, "did you mean '/physics/part/mass'?"},
      {message("/somewhere/else"), Kind::unknown, "`limber describe` lists all"},
      {message("no slash", 1), Kind::unknown, "it must begin with /"},
      {message("/", 1), Kind::rejected, "this is an object, not a property"},
      {message("", 1), Kind::unknown, "it must begin with /"},
      {message("/get"), Kind::rejected, "takes a path"},
      {message("/get", 3), Kind::rejected, "takes a path"},
      {message("/get", "/physics/body/arm"), Kind::rejected, "'/physics/body/arm' is not a property"},
      {message("/get", "/physics/sim/gravty"), Kind::rejected, "did you mean 'gravity'?"},
      {message("/list/parts"), Kind::rejected, "takes the name of a body"},
      {message("/list/parts", "arn"), Kind::rejected, "there is no body 'arn'; did you mean 'arm'?"},
      {message("/list/bodies", 1), Kind::rejected, "takes no arguments"},
      {message("/physics/part/applyforce", "arm", "tip", 1, 2), Kind::rejected, "takes 3 or 6 numbers"},
      {message("/physics/body/arm/reset", 1, 2), Kind::rejected, "takes no value, not 2"},
  };
  Rig rig;
  const std::vector<double> before = rig.everything();
  for (const Case& c : cases) {
    rig.dispatcher.begin_pass();
    const Outcome outcome = rig.dispatcher.execute(c.message);
    EXPECT_EQ(outcome.kind, c.kind) << c.message.address << ": " << c.expected_error;
    EXPECT_NE(outcome.error.find(c.expected_error), std::string::npos) << c.message.address << "\n  " << outcome.error;
    EXPECT_FALSE(outcome.sets_override);
  }
  EXPECT_EQ(rig.everything(), before);
}

TEST(MessageDispatcher, ClampsToTheRangeAndReportsIt) {
  Rig rig;
  const Outcome low = rig.send("/physics/part/mass", "arm", "tip", -3);
  EXPECT_EQ(low.kind, Kind::applied);
  EXPECT_EQ(low.clamped, &sim::Part::table().at("mass"));
  EXPECT_EQ(rig.read("/physics/body/arm/part/tip/mass"), (Values{0.001}));
  EXPECT_NE(rig.send("/physics/body/arm/part/tip/restitution", 7).clamped, nullptr);
  EXPECT_EQ(rig.read("/physics/body/arm/part/tip/restitution"), (Values{1}));
  EXPECT_NE(rig.send("/physics/sim/gravity", 1e9, 0, 0).clamped, nullptr);
  EXPECT_EQ(rig.read("/physics/sim/gravity"), (Values{1e4, 0, 0}));
  EXPECT_NE(rig.send("/physics/sim/substeps", 0).clamped, nullptr);
  EXPECT_EQ(rig.read("/physics/sim/substeps"), (Values{1}));
  EXPECT_EQ(rig.send("/physics/sim/substeps", 3).clamped, nullptr);
}

TEST(MessageDispatcher, TriggersActOnPressOnly) {
  Rig rig;
  const Arg bang;
  for (const Arg& press : {bang, arg(1), arg(true), arg(127)}) {
    EXPECT_EQ(rig.send("/physics/sim/reset", press).kind, Kind::applied);
    EXPECT_TRUE(std::exchange(rig.world.requests().reset, false));
  }
  EXPECT_EQ(rig.send("/physics/sim/reset").kind, Kind::applied);
  EXPECT_TRUE(std::exchange(rig.world.requests().reset, false));
  for (const Arg& release : {arg(0), arg(false)}) {
    EXPECT_EQ(rig.send("/physics/sim/reset", release).kind, Kind::applied);
    EXPECT_FALSE(std::exchange(rig.world.requests().reset, false));
  }
}

// two programs that send to each other must not query each other forever
TEST(MessageDispatcher, NoAnswerLooksLikeAQuery) {
  Rig full;
  struct {
    Store store;
    sim::World world{store};
    MessageDispatcher dispatch{world};
  } bare;
  ASSERT_TRUE(bare.world.add_body("floor").ok());
  const auto check = [](MessageDispatcher& dispatch, const Message& question) {
    dispatch.begin_pass();
    const Outcome asked = dispatch.execute(question);
    ASSERT_EQ(asked.kind, Kind::answered) << question.address << asked.error;
    for (const Message& answer : asked.answers) EXPECT_NE(dispatch.execute(answer).kind, Kind::answered);
  };
  for (MessageDispatcher* dispatch : {&full.dispatcher, &bare.dispatch}) {
    for (const char* list : {"/list/bodies", "/list/shapes", "/list/gears", "/list/groups"})
      check(*dispatch, message(list));
    for (const char* list : {"/list/parts", "/list/joints", "/list/motors", "/list/behaviors"}) {
      check(*dispatch, message(list, "floor"));
    }
    check(*dispatch, message("/get", "/physics/sim/*"));
  }
}

TEST(MessageDispatcher, NamesAStaticPartInErrors) {
  Rig rig;
  EXPECT_EQ(rig.send("/physics/part/mass", "arm", "base", 2).error,
            "part 'arm/base': the part was created static (mass 0); create it with a mass instead");
  EXPECT_EQ(rig.send("/physics/part/force", "arm", "base", 0, 0, 2).error, "part 'arm/base' is static and never moves");
}

TEST(MessageDispatcher, AnswersListsAndValues) {
  Rig rig;
  const auto words = [](const Outcome& outcome) {
    std::string text = outcome.answers.empty() ? "none" : outcome.answers[0].address;
    for (const Arg& a : outcome.answers.empty() ? std::vector<Arg>{} : outcome.answers[0].args) text += " " + a.text;
    return text;
  };
  EXPECT_EQ(words(rig.send("/list/bodies")), "/list/bodies arm 1 floor");
  EXPECT_EQ(words(rig.send("/list/parts", "arm")), "/list/parts arm base upper lower tip");
  EXPECT_EQ(words(rig.send("/list/joints", "arm")), "/list/joints arm shoulder elbow slide");
  EXPECT_EQ(words(rig.send("/list/motors", 1)), "/list/motors 1 shoulder");
  EXPECT_EQ(words(rig.send("/list/shapes")), "/list/shapes ball ground");
  EXPECT_EQ(words(rig.send("/list/joints", "floor")), "/list/joints floor ");

  const Outcome one = rig.send("/get", "/physics/body/arm/part/tip/position");
  ASSERT_EQ(one.answers.size(), 1U);
  EXPECT_EQ(one.answers[0].address, "/physics/body/arm/part/tip/position");
  ASSERT_EQ(one.answers[0].args.size(), 3U);
  EXPECT_EQ(one.answers[0].args[2].number, 2.5);
  const Outcome many = rig.send("/get", "/physics/body/*/motor/*/mode");
  ASSERT_EQ(many.answers.size(), 4U);
  EXPECT_EQ(many.answers[3].address, "/physics/body/1/motor/shoulder/mode");
  EXPECT_EQ(many.answers[3].args.size(), 1U);
  EXPECT_EQ(many.answers[3].args[0].number, 2) << "made as a servo";
  EXPECT_EQ(rig.send("/get", "//").kind, Kind::rejected);
  for (const SpecialAddress& special : MessageDispatcher::special_addresses())
    EXPECT_NE(rig.send(std::string(special.address)).kind, Kind::unknown) << special.address;
}

TEST(MessageDispatcher, LimitsHintsPerTick) {
  Rig rig;
  rig.dispatcher.begin_pass();
  int hinted = 0;
  for (int i = 0; i < 1000; i++) {
    const Outcome outcome = rig.dispatcher.execute(message("/physics/part/masss", 1));
    EXPECT_EQ(outcome.kind, Kind::unknown);
    hinted += outcome.error.find("did you mean") != std::string::npos;
  }
  EXPECT_EQ(hinted, HintBudget::kPerPass);
  rig.dispatcher.begin_pass();
  EXPECT_NE(rig.dispatcher.execute(message("/physics/part/masss", 1)).error.find("did you mean"), std::string::npos);
}

}  // namespace
}  // namespace limber::engine::test
