// The C API of the trusted Lua prelude: a struct of function pointers, generated from c_api.inc. [sim]
#pragma once

#include <cstdint>
#include <string>

namespace limber::script {

#define LIMBER_STRUCT(...) __VA_ARGS__
#define LIMBER_CALL(result, name, arguments)
#include "script/api/c_api.inc"
#undef LIMBER_CALL
#undef LIMBER_STRUCT

/// Results of most calls.
inline constexpr std::int32_t kOk = 0;
inline constexpr std::int32_t kClamped = 1;    ///< Done with a clamped value; details: the answer's text.
inline constexpr std::int32_t kRejected = -1;  ///< Nothing was done; reason: the answer's text.
inline constexpr std::int32_t kRemoved = -2;   ///< The object no longer exists.

struct LimberApi {
#define LIMBER_STRUCT(...)
#define LIMBER_CALL(result, name, arguments) result(*name) arguments;
#include "script/api/c_api.inc"
#undef LIMBER_CALL
#undef LIMBER_STRUCT
};

/// The functions; defined in the other files of this folder.
namespace calls {
#define LIMBER_STRUCT(...)
#define LIMBER_CALL(result, name, arguments) result name arguments;
#include "script/api/c_api.inc"
#undef LIMBER_CALL
#undef LIMBER_STRUCT
}  // namespace calls

/// The table of all functions.
const LimberApi& limber_api();
/// The same declarations as text for LuaJIT's ffi.cdef.
const std::string& limber_cdef();

}  // namespace limber::script
