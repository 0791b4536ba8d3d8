// sway: a pendulum from a text, and its angle each quarter of a second.
#include <limber.h>
#include <stdio.h>

int main(void) {
  limber_options options = LIMBER_OPTIONS;
  options.text =
      "local arm = sim:add_body('arm')\n"
      "arm:add_part('base', sim:add_box_shape('base', vec3(0.1, 0.1, 0.1)), { position = vec3(0, 0, 1), motion = 'static' })\n"
      "arm:add_part('rod', sim:add_box_shape('rod', vec3(0.05, 0.05, 0.6)), { position = vec3(0.3, 0, 1) })\n"
      "arm:add_joint('top', 'base', 'rod', { position = vec3(0, 0, 1), axis = vec3(0, 1, 0) })\n";
  limber_sim* sim = NULL;
  limber_property* angle = NULL;
  if (limber_create(&options, &sim) != LIMBER_OK ||
      limber_find(sim, "/physics/body/arm/joint/top/value", &angle) != LIMBER_OK) {
    fprintf(stderr, "sway: %s\n", limber_last_error());
    return 1;
  }
  for (int i = 0; i < 8; i++) {
    double value = 0;
    limber_step(sim, 15);
    limber_read(angle, &value, 1);
    printf("%.2f s: %.4f rad\n", limber_time(sim), value);
  }
  limber_destroy(sim);
  return 0;
}
