// What the compiler watches this build with. [any]
#pragma once

namespace limber {

#if defined(__SANITIZE_ADDRESS__)
#define LIMBER_WATCHES_ADDRESSES 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define LIMBER_WATCHES_ADDRESSES 1
#endif
#endif

#if defined(__SANITIZE_THREAD__)
#define LIMBER_WATCHES_THREADS 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define LIMBER_WATCHES_THREADS 1
#endif
#endif

#ifdef LIMBER_WATCHES_ADDRESSES
inline constexpr bool kWatchesAddresses = true;
#else
inline constexpr bool kWatchesAddresses = false;
#endif

#if defined(LIMBER_WATCHES_ADDRESSES) || defined(LIMBER_WATCHES_THREADS)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

}  // namespace limber
