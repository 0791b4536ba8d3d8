// balance: tries eight torques from the same state and keeps the one that lifts a rod highest.
#include <limber.h>

#include <cstdio>
#include <memory>

int main() {
  limber_options options = LIMBER_OPTIONS;
  options.text = R"(
    local arm = sim:add_body("arm")
    arm:add_part("base", sim:add_box_shape("base", vec3(0.1, 0.1, 0.1)), { position = vec3(0, 0, 1), motion = "static" })
    arm:add_part("rod", sim:add_box_shape("rod", vec3(0.05, 0.05, 0.6)), { position = vec3(0, 0, 0.7), mass = 1 })
    local top = arm:add_joint("top", "base", "rod", { position = vec3(0, 0, 1), axis = vec3(0, 1, 0) })
    arm:add_motor(top).mode = "torque"
  )";
  limber_sim* created = nullptr;
  if (limber_create(&options, &created) != LIMBER_OK) return std::puts(limber_last_error()), 1;
  const std::unique_ptr<limber_sim, void (*)(limber_sim*)> sim(created, limber_destroy);
  limber_property *torque = nullptr, *angle = nullptr;
  limber_state* start = nullptr;
  if (limber_find(created, "/physics/body/arm/motor/*/target_torque", &torque) != LIMBER_OK ||
      limber_find(created, "/physics/body/arm/joint/*/value", &angle) != LIMBER_OK ||
      limber_save(created, &start) != LIMBER_OK)
    return std::puts(limber_last_error()), 1;
  for (double value = 0.5; value <= 4; value += 0.5) {
    double reached = 0;
    limber_restore(created, start);
    limber_write(torque, &value, 1);
    limber_step(created, 30);
    limber_read(angle, &reached, 1);
    std::printf("%.1f N m: %.4f rad\n", value, reached);
  }
}
