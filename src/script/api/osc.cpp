// C API: OSC patterns, outgoing messages, ports declared by a scene.
#include <fmt/format.h>

#include "base/osc_pattern.h"
#include "base/text.h"
#include "script/api/script_context.h"
#include "script/vm/guard.h"

namespace limber::script::calls {

namespace {

// "127.0.0.1:9000" as IPv4 address in host byte order and port
struct HostPort {
  std::string host;
  std::uint32_t ip = 0;  // 0: the host is a name
  std::uint16_t port = 0;
};

std::optional<std::uint32_t> ip_of(std::string_view host) {
  if (host == "localhost") return 0x7f000001u;
  const auto bytes = split(host, '.');
  if (bytes.size() != 4) return {};
  std::uint32_t ip = 0;
  for (const std::string_view byte : bytes) {
    if (byte.empty() || byte.size() > 3 || byte.find_first_not_of("0123456789") != std::string_view::npos) return {};
    const double value = parse_number(byte).value_or(256);
    if (value > 255) return {};
    ip = ip << 8u | static_cast<std::uint32_t>(value);
  }
  return ip;
}

Result<HostPort> host_port(std::string_view text) {
  const std::size_t colon = text.rfind(':');
  const std::string_view digits = colon == std::string_view::npos ? std::string_view() : text.substr(colon + 1);
  const bool whole = !digits.empty() && digits.find_first_not_of("0123456789") == std::string_view::npos;
  const double port = whole ? parse_number(digits).value_or(0) : 0;
  if (port < 1 || port > 65535 || colon == 0 || printable(text) != text) {
    return Error{
        fmt::format("'{}' is not an address; write \"host:port\", such as \"127.0.0.1:9000\"", printable(text))};
  }
  const std::string_view host = text.substr(0, colon);
  return HostPort{std::string(host), ip_of(host).value_or(0), static_cast<std::uint16_t>(port)};
}

}  // namespace

std::int32_t osc_matches(void*, const char* pattern, std::int32_t pattern_length, const char* address,
                         std::int32_t length) {
  const std::string_view a = text_of(pattern, pattern_length);
  const std::string_view b = text_of(address, length);
  if (a == b) return 1;
  // both the handler's and the incoming address may be patterns
  return address_matches(a, b) || address_matches(b, a) ? 1 : 0;
}

void message_begin(void* c, const char* address, std::int32_t length) {
  context_of(c).arguments.message = {std::string(text_of(address, length)), {}};
}

void message_number(void* c, double x) { context_of(c).arguments.message.args.push_back(Arg::of(x)); }

void message_flag(void* c, std::int32_t on) { context_of(c).arguments.message.args.push_back(Arg::of(on != 0)); }

void message_text(void* c, const char* text, std::int32_t length) {
  context_of(c).arguments.message.args.push_back(Arg::of(text_of(text, length)));
}

std::int32_t message_send(void* c, std::int32_t route, double ip, std::int32_t port) {
  ScriptContext& context = context_of(c);
  if (route == 1 && !context.osc.handling_message) {
    return context.reject("osc:reply answers the message that is being handled: call it inside an osc:on function");
  }
  using Route = CallEffects::Route;
  const CommandOrigin direct{CommandSource::osc, static_cast<std::uint32_t>(ip), static_cast<std::uint16_t>(port)};
  const Route to = route == 0 ? Route::all : route == 1 ? Route::sender : Route::direct;
  if (context.effects.send(to, route == 1 ? context.osc.sender : direct, std::move(context.arguments.message)))
    return kOk;
  return context.reject(fmt::format("one call may send up to {} messages and 1 MB of text", CallEffects::kMaxMessages));
}

std::int32_t osc_address(void* c, const char* text, std::int32_t length) {
  ScriptContext& context = context_of(c);
  const Result<HostPort> parsed = host_port(text_of(text, length));
  if (!parsed) return context.reject(parsed.error());
  if (parsed->ip == 0) {
    return context.reject(
        fmt::format("'{}' is a host name, which scripts can't resolve; write a numeric address", parsed->host));
  }
  context.answer.number[0] = parsed->ip;
  context.answer.number[1] = parsed->port;
  return kOk;
}

void osc_handlers(void* c, std::int32_t count) { context_of(c).osc.handlers = count; }

std::int32_t disable_handler(void* c) {
  ScriptContext& context = context_of(c);
  if (!context.guard->limits().disable_failed_handlers) return 0;
  context.osc.disabled_handlers++;
  return 1;
}

void osc_listen(void* c, std::int32_t port) {
  context_of(c).osc.config.listen.push_back({"127.0.0.1", static_cast<std::uint16_t>(port)});
}

void osc_template(void* c, const char* address, std::int32_t address_length, const char* objects,
                  std::int32_t objects_length, const char* values, std::int32_t values_length, double scale,
                  std::int32_t per_body) {
  StreamMessage message{std::string(text_of(address, address_length)),
                        std::string(text_of(objects, objects_length)),
                        {},
                        scale,
                        per_body != 0};
  for (const std::string_view value : split(text_of(values, values_length), '\n')) message.values.emplace_back(value);
  context_of(c).osc.templates.push_back(std::move(message));
}

std::int32_t osc_target(void* c, const char* address, std::int32_t length, double rate, std::int32_t streams,
                        const char* bodies, std::int32_t bodies_length, std::int32_t bundle, std::int32_t errors) {
  ScriptContext& context = context_of(c);
  const Result<HostPort> parsed = host_port(text_of(address, length));
  if (!parsed) return context.reject(parsed.error());
  StreamTarget target;
  target.host = parsed->host;
  target.port = parsed->port;
  target.rate = rate;
  target.pos = (streams & 1) != 0;
  target.rot = (streams & 2) != 0;
  target.relrot = (streams & 4) != 0;
  target.relpos = (streams & 8) != 0;
  target.bodies = std::string(text_of(bodies, bodies_length));
  target.bundle = bundle;
  target.errors = errors != 0;
  target.messages = std::exchange(context.osc.templates, {});
  context.osc.config.targets.push_back(std::move(target));
  return kOk;
}

}  // namespace limber::script::calls
