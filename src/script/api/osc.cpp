// C API: OSC patterns, outgoing messages, ports declared by a scene.
#include <fmt/format.h>

#include "base/osc_pattern.h"
#include "base/system/net/socket.h"
#include "base/text.h"
#include "script/api/script_context.h"
#include "script/vm/guard.h"

namespace limber::script::calls {

namespace {

struct HostPort {
  std::string host;
  std::optional<system::IpAddress> ip;  // nothing: the host is a name
  std::uint16_t port = 0;
};

Result<HostPort> host_port(std::string_view text) {
  const system::HostPort parts = system::split_host_port(text);
  const bool whole = !parts.port.empty() && parts.port.find_first_not_of("0123456789") == std::string_view::npos;
  const double port = whole ? parse_number(parts.port).value_or(0) : 0;
  const bool is_v6 = parts.host.find(':') != std::string_view::npos;
  const bool valid =
      system::is_host_text(parts.host) && is_v6 == parts.bracketed && (!is_v6 || system::is_ip_address(parts.host));
  if (port < 1 || port > 65535 || !valid) {
    return Error{
        fmt::format("'{}' is not an address; write \"host:port\", such as \"127.0.0.1:9000\"", printable(text))};
  }
  if (const std::string fault = system::missing_zone(parts.host); !fault.empty()) return Error{fault};
  HostPort result{std::string(parts.host), system::parse_ip(parts.host), static_cast<std::uint16_t>(port)};
  if (parts.host == "localhost") result.ip = 0x7f000001U;
  return result;
}

system::Endpoint endpoint_of(const LimberAddress& address) {
  const bool is_v6 = address.is_v6 != 0;
  const system::IpAddress ip = is_v6 ? system::IpAddress(address.high, address.low, address.zone)
                                     : system::IpAddress(static_cast<std::uint32_t>(address.low));
  return {ip, static_cast<std::uint16_t>(address.port)};
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

std::int32_t message_send(void* c, std::int32_t route, const LimberAddress* to) {
  ScriptContext& context = context_of(c);
  if (route == 1 && !context.osc.handling_message) {
    return context.reject("osc:reply answers the message that is being handled: call it inside an osc:on function");
  }
  using Route = CallEffects::Route;
  const system::Endpoint end = to == nullptr ? system::Endpoint{} : endpoint_of(*to);
  const CommandOrigin direct{CommandSource::osc, end.ip, end.port};
  const Route way = route == 0 ? Route::all : route == 1 ? Route::sender : Route::direct;
  if (context.effects.send(way, route == 1 ? context.osc.sender : direct, std::move(context.arguments.message)))
    return kOk;
  return context.reject(fmt::format("one call may send up to {} messages and 1 MB of text", CallEffects::kMaxMessages));
}

std::int32_t osc_address(void* c, const char* text, std::int32_t length, LimberAddress* to) {
  ScriptContext& context = context_of(c);
  const Result<HostPort> parsed = host_port(text_of(text, length));
  if (!parsed) return context.reject(parsed.error());
  if (!parsed->ip && system::is_ip_address(parsed->host))
    return context.reject(fmt::format("'{}' names a network interface that does not exist", parsed->host));
  if (!parsed->ip) {
    return context.reject(
        fmt::format("'{}' is a host name, which scripts can't resolve; write a numeric address", parsed->host));
  }
  const system::IpAddress& ip = *parsed->ip;
  *to = {ip.high, ip.low, ip.zone, parsed->port, ip.is_v6 ? 1 : 0};
  return kOk;
}

std::int32_t address_text(void* c, const LimberAddress* address) {
  return context_of(c).set_text(system::endpoint_text(endpoint_of(*address)));
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
