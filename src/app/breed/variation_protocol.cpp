// The messages as JSON.
#include "app/breed/variation_protocol.h"

#include <cmath>

#include <nlohmann/json.hpp>

namespace limber::app {

namespace {

using Json = nlohmann::json;

bool is_size(int width, int height) {
  return width > 0 && height > 0 && width <= kMaxVariationSize && height <= kMaxVariationSize;
}

}  // namespace

std::string encode(const ImageRequest& request) {
  const MouseMovement& m = request.mouse;
  return Json{{"image", {request.width, request.height}},
              {"paused", request.paused},
              {"follow", request.follow},
              {"mouse", {m.orbit_x, m.orbit_y, m.pan_x, m.pan_y, m.wheel}}}
      .dump();
}

std::string encode(const ImageHeader& header) {
  return Json{{"number", header.number}, {"image", {header.width, header.height}}, {"error", header.error}}.dump(
      -1, ' ', false, Json::error_handler_t::replace);
}

std::optional<ImageRequest> decode_image_request(std::string_view line) try {
  const Json json = Json::parse(line);
  ImageRequest request;
  request.width = json.at("image").at(0);
  request.height = json.at("image").at(1);
  request.paused = json.at("paused");
  request.follow = json.at("follow");
  MouseMovement& m = request.mouse;
  const Json& mouse = json.at("mouse");
  double* const numbers[] = {&m.orbit_x, &m.orbit_y, &m.pan_x, &m.pan_y, &m.wheel};
  for (std::size_t i = 0; i < std::size(numbers); i++) {
    *numbers[i] = mouse.at(i);
    if (!std::isfinite(*numbers[i])) return std::nullopt;
  }
  return is_size(request.width, request.height) ? std::optional(request) : std::nullopt;
} catch (const Json::exception&) {
  return std::nullopt;
}

std::optional<ImageHeader> decode_image_header(std::string_view line) try {
  const Json json = Json::parse(line);
  ImageHeader header{json.at("number"), json.at("image").at(0), json.at("image").at(1), json.at("error")};
  const bool empty = header.width == 0 && header.height == 0;
  return empty || is_size(header.width, header.height) ? std::optional(header) : std::nullopt;
} catch (const Json::exception&) {
  return std::nullopt;
}

}  // namespace limber::app
