// Disables the leak check at exit: the leak sanitizer stops all threads, and sometimes crashes on those of a software
// OpenGL driver.

// NOLINTNEXTLINE(readability-identifier-naming, bugprone-reserved-identifier, cert-dcl37-c, cert-dcl51-cpp): its name
extern "C" int __lsan_is_turned_off() { return 1; }
