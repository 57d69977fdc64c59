"""OpenGL contexts without a window: EGL, or OSMesa where there is no EGL.

The context is made with ctypes before PyOpenGL is imported, because that import binds PyOpenGL to one platform for the
life of the process; and because the PyOpenGL that pyrender asks for lacks the call that makes an OSMesa core profile.
"""

from __future__ import annotations

import contextlib
import ctypes
import os
import sys
from collections.abc import Callable, Iterator
from ctypes import byref, c_char_p, c_int, c_uint, c_void_p
from ctypes.util import find_library
from types import MappingProxyType

from pectinate.errors import RenderingUnavailable

_REMEDY = "on Debian: apt-get install libegl1 libgl1 libgl1-mesa-dri (or libosmesa6 libgl1 where EGL cannot be had)"
_VARIABLE = "PYOPENGL_PLATFORM"

_EGL_PLATFORM_DEVICE, _EGL_PLATFORM_SURFACELESS = 0x313F, 0x31DD
_EGL_OPENGL_API = 0x30A2
# Ends with EGL_NONE: a pbuffer surface (0x3033), desktop OpenGL (0x3040), 24 bits of depth (0x3025).
_EGL_CONFIG = (c_int * 7)(0x3033, 1, 0x3040, 8, 0x3025, 24, 0x3038)
# OpenGL 3.3 core profile, the version of pyrender's shaders.
_EGL_CONTEXT = (c_int * 7)(0x3098, 3, 0x30FB, 3, 0x30FD, 1, 0x3038)
# RGBA, 24 bits of depth, core profile, 3.3; ends with 0.
_OSMESA_CONTEXT = (c_int * 11)(0x22, 0x1908, 0x30, 24, 0x33, 0x34, 0x36, 3, 0x37, 3, 0)
_GL_UNSIGNED_BYTE = 0x1401

Close = Callable[[], None]


@contextlib.contextmanager
def offscreen_context() -> Iterator[str]:
    """Make an offscreen OpenGL 3.3 core context current, and PyOpenGL ready to be imported for it.

    Honours PYOPENGL_PLATFORM ("egl" or "osmesa") and EGL_DEVICE_ID if they are set. Otherwise EGL is tried on every
    device, then OSMesa.

    Yields
    ------
    str
        "egl" or "osmesa".

    Raises
    ------
    RenderingUnavailable
        If neither works; the message names the packages to install.
    """
    platform, close = _open()
    os.environ.setdefault(_VARIABLE, platform)
    if platform == "osmesa":
        _mend_pyopengl()
    try:
        yield platform
    finally:
        close()


def _mend_pyopengl() -> None:
    """Let PyOpenGL use OSMesa contexts as keys: before 3.1.1 it gets them as pointers, which have no hash."""
    from OpenGL import platform  # noqa: PLC0415  (the import binds it to the platform that was just chosen)

    platform.PLATFORM.GetCurrentContext.restype = c_void_p


def _open() -> tuple[str, Close]:
    try:
        # pyrender imports pyglet, which needs this library on either platform, though it opens no window.
        _load("libGL.so.1", "GL")
    except (OSError, RenderingUnavailable) as error:
        raise RenderingUnavailable(f"no OpenGL library ({error}); {_REMEDY}") from error
    failures = []
    for platform in _candidates():
        try:
            return platform, _OPENERS[platform]()
        except (OSError, AttributeError, RenderingUnavailable) as error:
            failures.append(f"{platform}: {error}")
    raise RenderingUnavailable(f"no offscreen OpenGL ({'; '.join(failures)}); {_REMEDY}")


def _candidates() -> tuple[str, ...]:
    """Platforms to try: what PyOpenGL is bound to already, else what the user set, else both."""
    bound = getattr(sys.modules.get("OpenGL.platform"), "PLATFORM", None)
    if bound is not None:
        name = type(bound).__name__.removesuffix("Platform").lower()
        if name not in _OPENERS:
            raise RenderingUnavailable(
                f"PyOpenGL was imported before and is bound to {name}, which cannot draw offscreen: "
                f"set {_VARIABLE}=egl before the first import of OpenGL"
            )
        return (name,)
    name = os.environ.get(_VARIABLE, "")
    if name and name not in _OPENERS:
        raise RenderingUnavailable(f"{_VARIABLE}={name} cannot draw offscreen: set it to egl or osmesa, or unset it")
    return (name,) if name else tuple(_OPENERS)


def _open_egl() -> Close:
    egl = _load("libEGL.so.1", "EGL")
    for name in ("eglGetProcAddress", "eglGetDisplay", "eglCreateContext"):
        getattr(egl, name).restype = c_void_p
    if not hasattr(egl, "eglBindAPI"):
        raise RenderingUnavailable("this libEGL has no desktop OpenGL")
    displays = 0
    for display in _egl_displays(egl):
        displays += 1
        context = _egl_context(egl, display)
        if context is not None:
            return lambda: _close_egl(egl, display, context)
    raise RenderingUnavailable(f"none of {displays} EGL displays gives an OpenGL 3.3 core context")


def _egl_displays(egl: ctypes.CDLL) -> Iterator[c_void_p]:
    """Displays that need no window system: the devices first, then surfaceless, then the default."""
    devices = _egl_devices(egl)
    wanted = os.environ.get("EGL_DEVICE_ID")
    if wanted is not None:
        if not wanted.isdigit() or int(wanted) >= len(devices):
            raise RenderingUnavailable(f"EGL_DEVICE_ID={wanted}, but the devices are 0 to {len(devices) - 1}")
        devices = [devices[int(wanted)]]
    get_display = _egl_function(egl, "eglGetPlatformDisplayEXT", c_void_p, c_uint, c_void_p, c_void_p)
    if get_display is not None:
        for platform, native in [(_EGL_PLATFORM_DEVICE, device) for device in devices] + (
            [(_EGL_PLATFORM_SURFACELESS, None)] if wanted is None else []
        ):
            if display := get_display(platform, native, None):
                yield c_void_p(display)
    if wanted is None and (display := egl.eglGetDisplay(None)):
        yield c_void_p(display)


def _egl_devices(egl: ctypes.CDLL) -> list[c_void_p]:
    query = _egl_function(egl, "eglQueryDevicesEXT", c_uint, c_int, c_void_p, c_void_p)
    count = c_int()
    if query is None or not query(0, None, byref(count)):
        return []
    devices = (c_void_p * count.value)()
    query(count.value, devices, byref(count))
    return [c_void_p(device) for device in devices]


def _egl_function(egl: ctypes.CDLL, name: str, result: type, *arguments: type) -> Callable[..., int] | None:
    address = egl.eglGetProcAddress(c_char_p(name.encode()))
    return ctypes.CFUNCTYPE(result, *arguments)(address) if address else None


def _egl_context(egl: ctypes.CDLL, display: c_void_p) -> c_void_p | None:
    """A current context on the display, or None if the display cannot give one."""
    config, count = c_void_p(), c_int()
    if not egl.eglInitialize(display, None, None) or not egl.eglBindAPI(_EGL_OPENGL_API):
        return None
    if not egl.eglChooseConfig(display, _EGL_CONFIG, byref(config), 1, byref(count)) or not count.value:
        return None
    handle = egl.eglCreateContext(display, config, None, _EGL_CONTEXT)
    if not handle:
        return None
    context = c_void_p(handle)
    if egl.eglMakeCurrent(display, None, None, context):
        return context
    egl.eglDestroyContext(display, context)
    return None


def _close_egl(egl: ctypes.CDLL, display: c_void_p, context: c_void_p) -> None:
    # The display stays initialised: other libraries of the process may share it.
    egl.eglMakeCurrent(display, None, None, None)
    egl.eglDestroyContext(display, context)


def _open_osmesa() -> Close:
    osmesa = _load("libOSMesa.so.8", "OSMesa")
    osmesa.OSMesaCreateContextAttribs.restype = c_void_p
    handle = osmesa.OSMesaCreateContextAttribs(_OSMESA_CONTEXT, None)
    if not handle:
        raise RenderingUnavailable("no OpenGL 3.3 core context")
    context, buffer = c_void_p(handle), ctypes.create_string_buffer(4)

    def close() -> None:
        osmesa.OSMesaMakeCurrent(None, None, 0, 0, 0)
        osmesa.OSMesaDestroyContext(context)

    # Pictures are drawn in framebuffer objects, so that the context's own buffer can be one pixel.
    if not osmesa.OSMesaMakeCurrent(context, buffer, _GL_UNSIGNED_BYTE, 1, 1):
        osmesa.OSMesaDestroyContext(context)
        raise RenderingUnavailable("the context cannot be made current")
    return close


def _load(soname: str, name: str) -> ctypes.CDLL:
    """Load a library by the name it has on Linux, else by what the system calls it."""
    try:
        return ctypes.CDLL(soname, mode=ctypes.RTLD_GLOBAL)
    except OSError:
        path = find_library(name)
        if path is None:
            raise RenderingUnavailable(f"{soname} not found") from None
        return ctypes.CDLL(path, mode=ctypes.RTLD_GLOBAL)


_OPENERS = MappingProxyType({"egl": _open_egl, "osmesa": _open_osmesa})
