// A graphics card's device first, then no surface at all, then whatever is the default.
#include "view/offscreen.h"

#include <epoxy/egl.h>

#include <array>
#include <vector>

#include <fmt/format.h>

namespace limber {

namespace {

std::vector<EGLDisplay> displays() {
  std::vector<EGLDisplay> all;
  if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_device") &&
      epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration")) {
    std::array<EGLDeviceEXT, 8> devices{};
    EGLint count = 0;
    if (eglQueryDevicesEXT(static_cast<EGLint>(devices.size()), devices.data(), &count) == EGL_TRUE) {
      for (EGLint i = 0; i < count; i++)
        all.push_back(eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[static_cast<std::size_t>(i)], nullptr));
    }
  }
  if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless"))
    all.push_back(eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
  all.push_back(eglGetDisplay(EGL_DEFAULT_DISPLAY));
  return all;
}

EGLContext context_on(EGLDisplay display) {
  constexpr std::array<EGLint, 5> kConfig = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
  constexpr std::array<EGLint, 7> kContext = {
      EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
      EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (eglChooseConfig(display, kConfig.data(), &config, 1, &count) != EGL_TRUE || count == 0) return EGL_NO_CONTEXT;
  if (eglBindAPI(EGL_OPENGL_API) != EGL_TRUE) return EGL_NO_CONTEXT;
  const EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, kContext.data());
  if (context == EGL_NO_CONTEXT) return context;
  if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) == EGL_TRUE) return context;
  eglDestroyContext(display, context);
  return EGL_NO_CONTEXT;
}

}  // namespace

Result<std::unique_ptr<Offscreen>> Offscreen::make() {
  EGLint fault = EGL_SUCCESS;
  for (const EGLDisplay display : displays()) {
    if (display == EGL_NO_DISPLAY) continue;
    if (eglInitialize(display, nullptr, nullptr) != EGL_TRUE) {
      fault = eglGetError();
      continue;
    }
    if (const EGLContext context = context_on(display); context != EGL_NO_CONTEXT)
      return std::unique_ptr<Offscreen>(new Offscreen(display, context));
    fault = eglGetError();
    eglTerminate(display);
  }
  return Error{
      fmt::format("there is no OpenGL 3.3 without a display here (EGL's code 0x{:x}); on Debian it comes with "
                  "apt-get install libegl1 libgl1-mesa-dri",
                  fault)};
}

Offscreen::~Offscreen() {
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(display_, context_);
  // the display stays: drivers that are unloaded leave memory behind
}

}  // namespace limber
