// Tries the EGL displays of graphics devices first, then Mesa's surfaceless platform, then the default display.
#include "ui/render/offscreen.h"

#include <epoxy/egl.h>

#include <array>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/system/process.h"

namespace limber::render {

namespace {

constexpr const char* kEglLibrary = "libEGL.so.1";

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

struct Version {
  int major, minor;
  bool es;
};

// creates a context and makes it current
EGLContext context_on(EGLDisplay display, const Version& version) {
  const EGLint kind = version.es ? version.major > 2 ? EGL_OPENGL_ES3_BIT : EGL_OPENGL_ES2_BIT : EGL_OPENGL_BIT;
  const std::array<EGLint, 5> config_attributes = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, kind, EGL_NONE};
  std::vector<EGLint> attributes = {EGL_CONTEXT_MAJOR_VERSION, version.major, EGL_CONTEXT_MINOR_VERSION, version.minor};
  // older versions have no profiles
  if (!version.es && version.major == 3 && version.minor > 1)
    attributes.insert(attributes.end(), {EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT});
  attributes.push_back(EGL_NONE);
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (eglChooseConfig(display, config_attributes.data(), &config, 1, &count) != EGL_TRUE || count == 0)
    return EGL_NO_CONTEXT;
  if (eglBindAPI(version.es ? EGL_OPENGL_ES_API : EGL_OPENGL_API) != EGL_TRUE) return EGL_NO_CONTEXT;
  const EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes.data());
  if (context == EGL_NO_CONTEXT) return context;
  if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) == EGL_TRUE) return context;
  eglDestroyContext(display, context);
  return EGL_NO_CONTEXT;
}

// the versions that the driver supports, including unsupported old ones, for the error message
std::vector<std::string> offered_on(EGLDisplay display) {
  std::vector<std::string> names;
  for (const Version& version : {Version{1, 0, false}, Version{2, 0, true}}) {
    if (!gl_can_load(version.es ? GlApi::es : GlApi::core)) continue;
    const EGLContext context = context_on(display, version);
    if (context == EGL_NO_CONTEXT) continue;
    names.push_back(
        fmt::format("OpenGL {}{}.{}", version.es ? "ES " : "", epoxy_gl_version() / 10, epoxy_gl_version() % 10));
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display, context);
  }
  return names;
}

}  // namespace

Result<std::unique_ptr<OffscreenContext>> OffscreenContext::make(std::string_view choice) {
  const std::vector<GlApi> apis = gl_apis(choice);
  std::vector<std::string> offered;
  // checked first, because the function loader aborts the program if the library is missing
  if (!system::load_library(kEglLibrary)) return Error{gl_context_error(apis, offered)};
  for (const EGLDisplay display : displays()) {
    if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) != EGL_TRUE) continue;
    for (const GlApi api : apis) {
      if (!gl_can_load(api)) continue;
      const GlApiInfo& info = gl_api_info(api);
      const EGLContext context = context_on(display, {info.major, info.minor, api == GlApi::es});
      if (context != EGL_NO_CONTEXT)
        return std::unique_ptr<OffscreenContext>(new OffscreenContext(display, context, api));
    }
    if (offered.empty()) offered = offered_on(display);
    eglTerminate(display);
  }
  return Error{gl_context_error(apis, offered)};
}

bool OffscreenContext::make_current() const {
  return eglBindAPI(api_ == GlApi::es ? EGL_OPENGL_ES_API : EGL_OPENGL_API) == EGL_TRUE &&
         eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) == EGL_TRUE;
}

OffscreenContext::~OffscreenContext() {
  eglBindAPI(api_ == GlApi::es ? EGL_OPENGL_ES_API : EGL_OPENGL_API);
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(display_, context_);
  // the display is not terminated, because drivers leak memory when they are unloaded
}

CurrentContextGuard::CurrentContextGuard() : loaded_(system::load_library(kEglLibrary)) {
  if (!loaded_) return;
  api_ = eglQueryAPI();
  context_ = eglGetCurrentContext();
  if (context_ == EGL_NO_CONTEXT) return;
  display_ = eglGetCurrentDisplay();
  drawn_ = eglGetCurrentSurface(EGL_DRAW);
  read_ = eglGetCurrentSurface(EGL_READ);
}

// Without an own context, the one that is current now is released.
CurrentContextGuard::~CurrentContextGuard() {
  if (!loaded_) return;
  if (context_ != EGL_NO_CONTEXT) {
    eglBindAPI(api_);
    eglMakeCurrent(display_, drawn_, read_, context_);
    return;
  }
  const EGLDisplay current = eglGetCurrentDisplay();
  if (current != EGL_NO_DISPLAY) eglMakeCurrent(current, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglBindAPI(api_);
}

}  // namespace limber::render
