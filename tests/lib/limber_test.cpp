// The functions of limber.h: values, messages, events, states, errors.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "lib/scenes.h"

namespace limber::lib::test {
namespace {

TEST(Limber, WritesReachThePhysics) {
  const TestSim arm(kArm);
  limber_property* const targets = arm.find("/physics/body/arm/motor/*/target");
  limber_property* const angles = arm.find("/physics/body/arm/joint/*/value");
  ASSERT_EQ(limber_count(targets), 2u);
  ASSERT_EQ(limber_width(targets), 1u);
  const std::vector<double> wanted{0.5, -0.8};
  EXPECT_EQ(limber_write(targets, wanted.data(), 2), LIMBER_OK);
  EXPECT_EQ(arm.read(targets), wanted);
  arm.step(240);
  const std::vector<double> reached = arm.read(angles);
  for (std::size_t i = 0; i < 2; i++) EXPECT_NEAR(reached[i], wanted[i], 0.05);
}

TEST(Limber, WritesAreClampedToTheRange) {
  const TestSim arm(kArm);
  limber_property* const friction = arm.find("/physics/body/arm/part/*/friction");
  double min = 0;
  double max = 0;
  ASSERT_EQ(limber_range(friction, 0, &min, &max), LIMBER_OK);
  const std::vector<float> values{-1, 0.25F, 1e9F};
  EXPECT_EQ(limber_write_float(friction, values.data(), 3), LIMBER_OK);
  EXPECT_EQ(arm.read(friction), (std::vector<double>{min, 0.25, max}));
}

TEST(Limber, RejectedArraysChangeNothing) {
  const TestSim arm(kArm);
  limber_property* const targets = arm.find("/physics/body/arm/motor/*/target");
  const double bad[] = {1, std::numeric_limits<double>::quiet_NaN()};
  EXPECT_EQ(limber_write(targets, bad, 2), LIMBER_REJECTED);
  EXPECT_NE(std::string(limber_last_error()).find("/physics/body/arm/motor/"), std::string::npos);
  EXPECT_EQ(arm.read(targets), (std::vector<double>{0, 0}));
  EXPECT_EQ(limber_write(targets, bad, 1), LIMBER_INVALID_ARGUMENT);
  EXPECT_EQ(limber_write(arm.find("/physics/body/arm/joint/*/value"), bad, 2), LIMBER_REJECTED);
}

TEST(Limber, UnknownAddressesHaveHints) {
  const TestSim arm(kArm);
  limber_property* property = nullptr;
  EXPECT_EQ(limber_find(arm.sim, "/physics/body/arm/motor/elbow/targt", &property), LIMBER_NOT_FOUND);
  EXPECT_NE(std::string(limber_last_error()).find("target"), std::string::npos) << limber_last_error();
  EXPECT_EQ(property, nullptr);
  for (const char* address : {"/physics/body/legs/*/mass", "/physics/body/arm",
                              "/physics/body/arm/part/upper/apply_force", "/physics/body/arm/*/*/position", ""})
    EXPECT_EQ(limber_find(arm.sim, address, &property), LIMBER_NOT_FOUND) << address;
}

TEST(Limber, RestoreRepeatsTheRun) {
  const TestSim arm(kArm);
  arm.step(30);
  limber_state* state = nullptr;
  ASSERT_EQ(limber_save(arm.sim, &state), LIMBER_OK);
  const std::uint64_t before = arm.hash();
  arm.step(100);
  const std::uint64_t after = arm.hash();
  for (int i = 0; i < 3; i++) {
    ASSERT_EQ(limber_restore(arm.sim, state), LIMBER_OK) << limber_last_error();
    EXPECT_EQ(arm.hash(), before);
    EXPECT_EQ(limber_tick(arm.sim), 30u);
    arm.step(100);
    EXPECT_EQ(arm.hash(), after);
  }
  limber_discard(state);
}

TEST(Limber, StatesOfAnotherRunAreStale) {
  const TestSim arm(kArm);
  const TestSim other(kArm);
  limber_state* state = nullptr;
  ASSERT_EQ(limber_save(arm.sim, &state), LIMBER_OK);
  EXPECT_EQ(limber_restore(other.sim, state), LIMBER_INVALID_ARGUMENT);
  ASSERT_EQ(limber_reset(arm.sim, nullptr), LIMBER_OK);
  EXPECT_EQ(limber_restore(arm.sim, state), LIMBER_STALE);
}

TEST(Limber, StatesAreStaleAfterObjectsWereAdded) {
  const TestSim growing(R"(
    osc:on("/grow", function() sim:add_body("more"):add_part("ball", sim:add_sphere_shape("ball", 0.1)) end)
  )");
  limber_state* state = nullptr;
  ASSERT_EQ(limber_save(growing.sim, &state), LIMBER_OK);
  ASSERT_EQ(limber_send(growing.sim, "/grow", nullptr, 0), LIMBER_OK) << limber_last_error();
  EXPECT_EQ(limber_restore(growing.sim, state), LIMBER_STALE) << growing.log.all();
}

TEST(Limber, ResetEqualsANewSimulation) {
  const TestSim arm(kArm, 3);
  arm.step(50);
  const std::uint64_t third = arm.hash();
  limber_property* const angles = arm.find("/physics/body/arm/joint/*/value");
  for (const std::uint64_t seed : {std::uint64_t{7}, std::uint64_t{7}, std::uint64_t{3}}) {
    ASSERT_EQ(limber_reset(arm.sim, &seed), LIMBER_OK) << limber_last_error();
    EXPECT_EQ(limber_tick(arm.sim), 0u);
    arm.step(50);
    EXPECT_EQ(arm.read(angles).size(), 2u);
    const TestSim fresh(kArm, seed);
    fresh.step(50);
    EXPECT_EQ(arm.hash(), fresh.hash()) << seed;
    EXPECT_EQ(arm.hash() == third, seed == 3);
  }
  ASSERT_EQ(limber_reset(arm.sim, nullptr), LIMBER_OK);
  arm.step(50);
  EXPECT_EQ(arm.hash(), third);
}

TEST(Limber, AddressesRemainValidAfterAReset) {
  const TestSim arm(kArm);
  limber_property* const angles = arm.find("/physics/body/arm/joint/*/value");
  const char* const address = limber_address(angles, 1);
  const std::string text = address;
  ASSERT_EQ(limber_reset(arm.sim, nullptr), LIMBER_OK) << limber_last_error();
  EXPECT_EQ(arm.read(angles).size(), 2u);
  EXPECT_EQ(limber_address(angles, 1), address);
  EXPECT_EQ(address, text);
}

TEST(Limber, FailedResetsChangeNothing) {
  const TestSim sim(R"(
    if sim.seed == 2 then error("no seed 2") end
    sim:add_body("ball"):add_part("ball", sim:add_sphere_shape("ball", 0.1))
  )");
  const limber_value gravity[] = {
      {LIMBER_NUMBER, 0, nullptr}, {LIMBER_NUMBER, 0, nullptr}, {LIMBER_NUMBER, -1, nullptr}};
  ASSERT_EQ(limber_send(sim.sim, "/physics/sim/gravity", gravity, 3), LIMBER_OK) << limber_last_error();
  sim.step(10);
  const std::uint64_t before = sim.hash();
  const std::uint64_t bad = 2;
  EXPECT_EQ(limber_reset(sim.sim, &bad), LIMBER_SCENE_ERROR);
  EXPECT_NE(sim.log.all().find("no seed 2"), std::string::npos) << sim.log.all();
  EXPECT_EQ(sim.hash(), before);
  EXPECT_EQ(limber_tick(sim.sim), 10u);
  EXPECT_EQ(limber_reset(sim.sim, nullptr), LIMBER_OK) << limber_last_error();
  EXPECT_EQ(limber_tick(sim.sim), 0u);
}

TEST(Limber, MessagesAreExecutedAtOnce) {
  const TestSim sim(R"(osc:on("/echo", function(number, text) osc:send("/reply", number + 1, text) end))");
  const limber_value values[] = {{LIMBER_NUMBER, 4, nullptr}, {LIMBER_TEXT, 0, "word"}};
  ASSERT_EQ(limber_send(sim.sim, "/echo", values, 2), LIMBER_OK) << limber_last_error();
  limber_event event{};
  ASSERT_EQ(limber_next_event(sim.sim, &event), LIMBER_OK);
  EXPECT_STREQ(event.address, "/reply");
  ASSERT_EQ(event.count, 2u);
  EXPECT_EQ(event.values[0].number, 5);
  EXPECT_STREQ(event.values[1].text, "word");
  EXPECT_EQ(limber_next_event(sim.sim, &event), LIMBER_NONE);
  EXPECT_EQ(limber_send(sim.sim, "/physics/sim/gravit", values, 1), LIMBER_REJECTED);
  EXPECT_NE(std::string(limber_last_error()).find("gravity"), std::string::npos) << limber_last_error();
  EXPECT_EQ(limber_send(sim.sim, "/take/record", nullptr, 0), LIMBER_REJECTED);
  EXPECT_EQ(limber_send(sim.sim, "no slash", nullptr, 0), LIMBER_INVALID_ARGUMENT);
}

TEST(Limber, ContactsCarryTheWeight) {
  const TestSim box(R"(
    sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"))
    sim:add_body("box"):add_part("box", sim:add_box_shape("box", vec3(0.4, 0.4, 0.4)), { position = vec3(0, 0, 0.2), mass = 2,
      report_contacts = true })
  )");
  box.step(120);
  std::vector<limber_contact> contacts(16);
  std::size_t count = 0;
  ASSERT_EQ(limber_contacts(box.sim, contacts.data(), contacts.size(), &count), LIMBER_OK);
  ASSERT_GE(count, 3u);
  double impulse = 0;
  for (std::size_t i = 0; i < count; i++) {
    EXPECT_STREQ(contacts[i].body_a, "floor");
    EXPECT_STREQ(contacts[i].part_b, "box");
    EXPECT_NEAR(contacts[i].normal[2], -1, 1e-3);
    impulse += contacts[i].impulse;
  }
  EXPECT_NEAR(impulse / limber_timestep(box.sim), 2 * 9.81, 0.2);
}

TEST(Limber, ErrorsOfScenesNameFileAndLine) {
  limber_options options = LIMBER_OPTIONS;
  limber_sim* sim = nullptr;
  options.text = "local x = 1\nx.y.z = 2\n";
  options.file = "broken.lua";
  EXPECT_EQ(limber_create(&options, &sim), LIMBER_SCENE_ERROR);
  EXPECT_NE(std::string(limber_last_error()).find("broken.lua:2:"), std::string::npos) << limber_last_error();
  EXPECT_EQ(sim, nullptr);
  options.text = nullptr;
  options.file = "missing.lua";
  EXPECT_EQ(limber_create(&options, &sim), LIMBER_SCENE_ERROR);
  EXPECT_NE(std::string(limber_last_error()).find("missing.lua"), std::string::npos) << limber_last_error();
}

TEST(Limber, BadArgumentsAreErrors) {
  limber_sim* sim = nullptr;
  limber_options options = LIMBER_OPTIONS;
  EXPECT_EQ(limber_create(&options, &sim), LIMBER_INVALID_ARGUMENT);
  EXPECT_EQ(limber_create(nullptr, &sim), LIMBER_INVALID_ARGUMENT);
  options.text = "";
  options.threads = 1000;
  EXPECT_EQ(limber_create(&options, &sim), LIMBER_INVALID_ARGUMENT);
  options.threads = 0;
  options.size--;
  EXPECT_EQ(limber_create(&options, &sim), LIMBER_INVALID_ARGUMENT);
  EXPECT_EQ(limber_step(nullptr, 1), LIMBER_INVALID_ARGUMENT);
  EXPECT_EQ(limber_read(nullptr, nullptr, 0), LIMBER_INVALID_ARGUMENT);
  EXPECT_EQ(limber_address(nullptr, 0), nullptr);
  limber_destroy(nullptr);
  limber_release(nullptr);
  limber_discard(nullptr);
}

}  // namespace
}  // namespace limber::lib::test
