// The leak sanitizer stops a process's threads to look at them, and crashes now and then where they are a software
// driver's: these tests end without its search.

// NOLINTNEXTLINE(readability-identifier-naming, bugprone-reserved-identifier, cert-dcl37-c, cert-dcl51-cpp): its name
extern "C" int __lsan_is_turned_off() { return 1; }
