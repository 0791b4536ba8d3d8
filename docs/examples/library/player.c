// player: plays a scene as fast as possible and prints its state hash, as `limber SCENE --fast --hash` does.
//   player SCENE [--duration SECONDS] [--seed NUMBER] [--threads NUMBER]
#include <limber.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void print_line(void* context, limber_log_level level, const char* text) {
  const char* const labels[] = {"", "warning: ", "error: "};
  (void)context;
  if (level == LIMBER_LOG_PRINT) {
    printf("%s\n", text);
  } else {
    fprintf(stderr, "player: %s%s\n", labels[level], text);
  }
}

static int fail(void) {
  fprintf(stderr, "player: %s\n", limber_last_error());
  return 1;
}

int main(int count, char** arguments) {
  limber_options options = LIMBER_OPTIONS;
  double duration = 10;
  uint64_t seed = 0;
  for (int i = 1; i < count; i++) {
    const char* const value = i + 1 < count ? arguments[i + 1] : "";
    if (strcmp(arguments[i], "--duration") == 0) {
      duration = atof(value);
    } else if (strcmp(arguments[i], "--seed") == 0) {
      seed = strtoull(value, NULL, 10);
      options.seed = &seed;
    } else if (strcmp(arguments[i], "--threads") == 0) {
      options.threads = atoi(value);
    } else {
      options.file = arguments[i];
      continue;
    }
    i++;
  }
  options.log = print_line;
  limber_sim* sim = NULL;
  if (limber_create(&options, &sim) != LIMBER_OK) return fail();
  while (limber_time(sim) < duration - 1e-9) {
    if (limber_step(sim, 1) != LIMBER_OK) return fail();
  }
  uint64_t hash = 0;
  if (limber_hash(sim, &hash) != LIMBER_OK) return fail();
  printf("hash %016llx tick %llu\n", (unsigned long long)hash, (unsigned long long)limber_tick(sim));
  limber_destroy(sim);
  return 0;
}
