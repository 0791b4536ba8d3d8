// The 52 addresses of ofxDabPhysics, from its documentation and code, for tests that send each in every form.
#pragma once

#include <cstddef>
#include <string>

#include <fmt/format.h>

namespace limber::engine::test {

struct Address {
  const char* class_name;  // class
  const char* address;     // in the documentation of ofxDabPhysics
  const char* property;    // name of the property
  std::size_t width;       // numbers
  bool flags = false;
};

/// Addresses that take a body and an element as arguments.
inline constexpr Address kElementAddresses[] = {
    {"part", "mass", "mass", 1},
    {"part", "lineardamping", "linear_damping", 1},
    {"part", "angulardamping", "angular_damping", 1},
    {"part", "friction", "friction", 1},
    {"part", "rollingfriction", "rolling_friction", 1},
    {"part", "restitution", "restitution", 1},
    {"joint", "linearstoperp", "linear_stop_erp", 3},
    {"joint", "angularstoperp", "angular_stop_erp", 3},
    {"joint", "linearstopcfm", "linear_stop_cfm", 3},
    {"joint", "angularstopcfm", "angular_stop_cfm", 3},
    {"joint", "linearlowerlimit", "linear_lower_limit", 3},
    {"joint", "linearupperlimit", "linear_upper_limit", 3},
    {"joint", "angularlowerlimit", "angular_lower_limit", 3},
    {"joint", "angularupperlimit", "angular_upper_limit", 3},
    {"motor", "bounce", "bounce", 1},
    {"motor", "damping", "damping", 1},
    {"motor", "linearactive", "linear_active", 3, true},
    {"motor", "angularactive", "angular_active", 3, true},
    {"motor", "maxlinearforce", "max_linear_force", 3},
    {"motor", "maxangularforce", "max_angular_force", 3},
    {"motor", "linearvelocity", "linear_velocity", 3},
    {"motor", "angularvelocity", "angular_velocity", 3},
    {"motor", "linearservoactive", "linear_servo_active", 3, true},
    {"motor", "angularservoactive", "angular_servo_active", 3, true},
    {"motor", "linearservoposition", "linear_servo_position", 3},
    {"motor", "angularservoposition", "angular_servo_position", 3},
    {"motor", "linearspringactive", "linear_spring_active", 3, true},
    {"motor", "angularspringactive", "angular_spring_active", 3, true},
    {"motor", "linearspringrestlength", "linear_spring_rest_length", 3},
    {"motor", "linearspringstiffness", "linear_spring_stiffness", 3},
    {"motor", "linearspringdamping", "linear_spring_damping", 3},
    {"motor", "angularspringrestlength", "angular_spring_rest_length", 3},
    {"motor", "angularspringstiffness", "angular_spring_stiffness", 3},
    {"motor", "angularspringdamping", "angular_spring_damping", 3},
};

/// Addresses that take a shape.
inline constexpr Address kShapeAddresses[] = {
    {"shape", "transparency", "transparency", 1},  {"shape", "ambientscale", "ambient_scale", 1},
    {"shape", "diffusescale", "diffuse_scale", 1}, {"shape", "specularscale", "specular_scale", 1},
    {"shape", "specularpow", "specular_pow", 1},   {"shape", "ambientcolor", "ambient_color", 3},
    {"shape", "diffusecolor", "diffuse_color", 3},
};

/// Addresses without names.
inline constexpr const char* kSingletonAddresses[] = {"/physics/sim/gravity",     "/physics/sim/timestep",
                                                      "/physics/sim/substeps",    "/visuals/camera/projection",
                                                      "/visuals/camera/position", "/visuals/camera/rotation"};

/// Special addresses, and those that are rejected with a reason.
inline constexpr const char* kOtherAddresses[] = {"/physics/part/force", "/physics/behavior/parameter",
                                                  "/physics/joint/basis", "/physics/joint/prevpos",
                                                  "/physics/joint/nextpos"};

static_assert(std::size(kElementAddresses) + std::size(kShapeAddresses) + std::size(kSingletonAddresses) +
                  std::size(kOtherAddresses) ==
              52);

inline std::string legacy_address(const Address& a) {
  const bool shape = std::string_view(a.class_name) == "shape";
  return fmt::format("{}/{}/{}", shape ? "/visuals" : "/physics", a.class_name, a.address);
}

}  // namespace limber::engine::test
