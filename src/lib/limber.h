// limber.h: the C interface of Limber, the simulator of articulated bodies.
//
// A program creates simulations from scenes (Lua), steps them, reads and sets properties as arrays, and saves and
// restores their state in memory. The state depends on the scene, its seed and the values that were set, and is
// identical to the bit to that of the program `limber` on every machine; limber_hash() compares it.
//
// Errors. Functions return a limber_status. After every status other than LIMBER_OK, limber_last_error() has its text:
// the place, the problem, and how to fix it. A function that fails has changed nothing, unless its comment tells
// otherwise. Invalid pointers are the only arguments that are not checked, except null.
//
// Threads. A process may have any number of simulations. Each may be used on any thread, by one thread at a time; a
// call during another call returns LIMBER_BUSY. Scripts are compiled in one simulation of a process, and interpreted in
// the others, with the same result. After a fork, the child can't use the simulations of its parent
// (LIMBER_WRONG_PROCESS); it creates its own.
//
// The process. The library changes no handler of a signal that the process handles, no locale, rounding mode, output or
// memory allocator. It writes nothing to standard output and standard error: log lines go to limber_options::log. To
// stop scripts that compute too long, it uses SIGURG, which is ignored by default, or if the process handles SIGURG,
// the highest real-time signal without a handler, and unblocks it in threads that call the library. Mathematical
// functions of LuaJIT and Bullet (libluajit-5.1.so, libBullet*.so) are those of Limber as soon as the first simulation
// exists: their results then don't depend on the C library.
//
// Units: m, kg, s, N, rad, unless limber_unit() tells otherwise. Numbers of an array are contiguous.
#ifndef LIMBER_H
#define LIMBER_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define LIMBER_API __attribute__((visibility("default")))
#else
#define LIMBER_API
#endif

/* Version of this interface. A library with the same major number and a higher minor number has everything that is
 * declared here. */
#define LIMBER_INTERFACE_MAJOR 1
#define LIMBER_INTERFACE_MINOR 1

typedef enum limber_status {
  LIMBER_OK = 0,
  LIMBER_INVALID_ARGUMENT = 1, /* null, a wrong size, an option out of its range */
  LIMBER_SCENE_ERROR = 2,      /* the scene can't be read or its script fails; the text has file and line */
  LIMBER_NOT_FOUND = 3,        /* no property has this address; the text has similar names */
  LIMBER_REJECTED = 4,         /* a value or message was rejected: not finite, read-only, unknown */
  LIMBER_STALE = 5,            /* the objects of the property, or the scene of the state, no longer exist */
  LIMBER_BUSY = 6,             /* another thread uses the simulation, or a log callback calls the library */
  LIMBER_WRONG_PROCESS = 7,    /* the simulation belongs to the process that forked this one */
  LIMBER_NO_MEMORY = 8,        /* not enough memory or threads */
  LIMBER_NONE = 9,             /* there is no event */
  LIMBER_NO_GRAPHICS = 10      /* images can't be drawn: OpenGL or a driver is missing; the text has the fix (1.1) */
} limber_status;

typedef struct limber_sim limber_sim;           /* a simulation */
typedef struct limber_property limber_property; /* a property of one or more objects of a simulation */
typedef struct limber_state limber_state;       /* a saved state of a simulation */

typedef enum limber_log_level {
  LIMBER_LOG_INFO = 0,
  LIMBER_LOG_WARNING = 1,
  LIMBER_LOG_ERROR = 2,
  LIMBER_LOG_PRINT = 3 /* a line of a script's print() */
} limber_log_level;

/* Receives a log line without its line end, on the thread of the call that causes it: UTF-8, except bytes that a script
 * prints. It must not call the library with the same simulation. */
typedef void (*limber_log_function)(void* context, limber_log_level level, const char* text);

/* Options of a simulation. Begin with LIMBER_OPTIONS, which sets the size and all others to 0. */
typedef struct limber_options {
  size_t size;             /* sizeof(limber_options) */
  const char* file;        /* scene file, or with `text` its name: where it finds other files (null: ./scene.lua) */
  const char* text;        /* text of the scene; null: it is read from `file` */
  const char* data;        /* folder with the installed scripts/ and urdf/; null: share/limber beside the library */
  const uint64_t* seed;    /* random seed, 0 to 2^53; null: that of the scene */
  int threads;             /* threads of each physics step, 1 to 64, 0: 1; the result is the same for any number */
  limber_log_function log; /* null: log lines are dropped */
  void* log_context;       /* first argument of `log` */
} limber_options;

#define LIMBER_OPTIONS \
  { sizeof(limber_options), NULL, NULL, NULL, NULL, 0, NULL, NULL }

/* Returns the version of the library as text: "0.4.0". Its interface is (*major, *minor); either may be null. */
LIMBER_API const char* limber_version(int* major, int* minor);

/* Returns the folder with the installed scripts/ and urdf/, which scenes use; "" if there is none (since 1.1). */
LIMBER_API const char* limber_data_folder(void);

/* Returns the text of the last error on this thread; valid until its next call that fails. */
LIMBER_API const char* limber_last_error(void);

/* Creates a simulation and runs its scene up to the first tick. */
LIMBER_API limber_status limber_create(const limber_options* options, limber_sim** out);

/* Destroys a simulation with its properties and states. Null is ignored. */
LIMBER_API void limber_destroy(limber_sim* sim);

/* Advances time by this number of ticks. Errors of callbacks are logged and counted by limber_faults(), and the
 * simulation continues. A scene that has paused itself does not advance; compare limber_tick(). */
LIMBER_API limber_status limber_step(limber_sim* sim, uint64_t ticks);

/* Runs the scene from its start: with the seed (0 to 2^53), or if it is null, with the same seed as before. Properties
 * remain valid if their addresses exist, states don't. */
LIMBER_API limber_status limber_reset(limber_sim* sim, const uint64_t* seed);

/* The number of ticks since the start, the simulated time in s, and the length of a tick in s; 0 for null. */
LIMBER_API uint64_t limber_tick(const limber_sim* sim);
LIMBER_API double limber_time(const limber_sim* sim);
LIMBER_API double limber_timestep(const limber_sim* sim);

/* The number of script errors, rejected values and unstable bodies since the start. */
LIMBER_API uint64_t limber_faults(const limber_sim* sim);

/* The hash of the state: of all bodies, settings, scripts and random numbers, equal to that of `limber --hash`. */
LIMBER_API limber_status limber_hash(limber_sim* sim, uint64_t* hash);

/* ---- properties */

// Finds a property by its address (/physics/body/arm/motor/elbow/target), or those of several objects by an OSC pattern
// (/physics/body/arm/motor/*/target): `*`, `?`, `[a-z]`, `{a,b}` within a name, `//` for any depth. All must be the
// same property of the same class; their order is that of the tree. `limber describe` lists the properties of each
// class. Free it with limber_release().
LIMBER_API limber_status limber_find(limber_sim* sim, const char* address, limber_property** out);
LIMBER_API void limber_release(limber_property* property);

/* The number of objects, and of numbers per object: 1, 3 (a vector) or 4 (a quaternion x y z w). An array of the
 * property has count * width numbers, all numbers of an object together. */
LIMBER_API size_t limber_count(const limber_property* property);
LIMBER_API size_t limber_width(const limber_property* property);
/* The address of an object's property; null if `index` is not below the count. Valid until limber_release(), or until
 * the scene has run again and has another object in its place. */
LIMBER_API const char* limber_address(const limber_property* property, size_t index);
/* The symbol of the unit; "" for a number without unit. Valid as long as the process. */
LIMBER_API const char* limber_unit(const limber_property* property);
/* 1 if the property can be set. */
LIMBER_API int limber_writable(const limber_property* property);
/* The range of a number (0 to width - 1) of the property, to which values are clamped; infinite without a limit. */
LIMBER_API limber_status limber_range(const limber_property* property, size_t number, double* min, double* max);

/* Copies the values to an array. `size`: numbers in the array, count * width. Allocates nothing. */
LIMBER_API limber_status limber_read(limber_property* property, double* values, size_t size);
LIMBER_API limber_status limber_read_float(limber_property* property, float* values, size_t size);
/* Sets the values, which are clamped to their ranges and take effect in the next tick. They are no overrides: a reset
 * drops them. If a value is rejected (such as NaN), nothing is set. Allocates nothing. */
LIMBER_API limber_status limber_write(limber_property* property, const double* values, size_t size);
LIMBER_API limber_status limber_write_float(limber_property* property, const float* values, size_t size);

/* ---- messages */

typedef enum limber_value_kind {
  LIMBER_NUMBER = 0,
  LIMBER_BOOLEAN = 1, /* `number` is 1 or 0 */
  LIMBER_TEXT = 2,
  LIMBER_NIL = 3
} limber_value_kind;

typedef struct limber_value {
  limber_value_kind kind;
  double number;
  const char* text; /* UTF-8 */
} limber_value;

/* Sends an OSC message to the simulation, which executes it at once, without a step; then the handlers of the scene are
 * called (osc:on). Everything that a controller can send works: values with patterns, actions, presets. Settings are
 * overrides: a reset keeps them until limber_reset(). Answers are events. */
LIMBER_API limber_status limber_send(limber_sim* sim, const char* address, const limber_value* values, size_t count);

/* A message from the simulation: an answer, a message of the scene (osc:send), a contact (/physics/contact, of parts
 * with report_contacts), the start of a pause. */
typedef struct limber_event {
  const char* address;
  const limber_value* values;
  size_t count;
} limber_event;

/* Returns the oldest event and removes it; its data are valid until the next call with this simulation. LIMBER_NONE if
 * there is none. The newest 4096 events are kept. */
LIMBER_API limber_status limber_next_event(limber_sim* sim, limber_event* event);

/* A point at which two parts touched in the last tick. Parts report contacts if their `report_contacts` is true. */
typedef struct limber_contact {
  const char* body_a; /* names, valid until the next call with this simulation that isn't limber_contacts() */
  const char* part_a;
  const char* body_b;
  const char* part_b;
  double position[3]; /* world, m */
  double normal[3];   /* world, the direction in which b pushes a */
  double impulse;     /* along the normal, sum over the tick, N s */
  double friction[3]; /* friction impulse on a, sum over the tick, N s */
  double distance;    /* m; negative: penetration */
} limber_contact;

/* Copies the contacts of the last tick, at most `capacity`; `count` is the number of all. */
LIMBER_API limber_status limber_contacts(limber_sim* sim, limber_contact* contacts, size_t capacity, size_t* count);

/* ---- states */

/* Saves the whole state in memory. It belongs to the simulation, whose destruction frees it. States share memory that
 * is equal. */
LIMBER_API limber_status limber_save(limber_sim* sim, limber_state** out);
/* Restores a state of the same simulation. The run after it is identical to the run after the save, if the same values
 * are set. LIMBER_STALE if the scene has run again since, or has added or removed objects. */
LIMBER_API limber_status limber_restore(limber_sim* sim, const limber_state* state);
/* Frees a state. Null is ignored. */
LIMBER_API void limber_discard(limber_state* state);

/* ---- images (since 1.1) */

typedef enum limber_quality {
  LIMBER_QUALITY_HIGH = 0, /* as in films */
  LIMBER_QUALITY_MEDIUM = 1,
  LIMBER_QUALITY_LOW = 2 /* the fastest: no shadows, hard edges */
} limber_quality;

/* An image to draw. Begin with LIMBER_IMAGE, which sets the size of the structure and the image, 640 x 480. */
typedef struct limber_image {
  size_t size;            /* sizeof(limber_image) */
  int width, height;      /* pixels */
  const double* position; /* of the camera, 3 numbers: world, m; null: that of the scene's camera */
  const double* target;   /* the point that it looks at, upright; null: that of the scene's camera */
  double fovy;            /* vertical field of view, degrees; 0: that of the scene's camera */
  limber_quality quality;
} limber_image;

#define LIMBER_IMAGE \
  { sizeof(limber_image), 640, 480, NULL, NULL, 0, LIMBER_QUALITY_HIGH }

/* Draws the present state into an array of width * height * 3 bytes (`size`): rows from top to bottom, red, green, blue
 * (sRGB). It needs no display and changes no state. The first image loads OpenGL (libEGL, and a driver, such as Mesa's
 * for software) and creates a context of the simulation; a process that draws none loads none. The context that was
 * current on the thread is current afterwards. In a child of a process that has drawn images it fails, because drivers
 * have threads. */
LIMBER_API limber_status limber_render(limber_sim* sim, const limber_image* image, uint8_t* pixels, size_t size);

#ifdef __cplusplus
}
#endif

#endif
