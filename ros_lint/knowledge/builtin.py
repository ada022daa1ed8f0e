"""Names that Python, the C++ tool chain or CMake provide, so that a manifest need not declare a package for them."""

from __future__ import annotations

from ros_lint.collectors.python.versions import PYTHON_OF, STANDARD_LIBRARY

_SEPARATE_MODULES = frozenset({"tkinter"})
"""Modules of Python's standard library that Debian and Ubuntu ship in packages other than that of Python."""
PYTHON_MODULES = STANDARD_LIBRARY - _SEPARATE_MODULES
"""Top-level modules of Python's standard library in any version from 3.10 to 3.14, without ``_SEPARATE_MODULES``."""

_REMOVED_MODULES = {"distutils": ((3, 12), "python3-setuptools")}
"""Modules that Python removed: for each, the first version without the module, and the rosdep key of a replacement.

``distutils`` was removed by PEP 632; setuptools installs a module of the same name (``distutils-precedence.pth``).
"""


def replacement_key(module: str, distro: str) -> str:
    """Return the rosdep key of the replacement for a top-level module that Python removed, "" if there is none.

    The result is also "" if the Python version of the distribution still has the module.
    """
    version, key = _REMOVED_MODULES.get(module, ((0, 0), ""))
    return key if key and PYTHON_OF.get(distro, (0, 0)) >= version else ""


_CMAKE_MODULES = """
ALSA ASPELL AVIFile Armadillo BISON BLAS BZip2 Backtrace Boost Bullet CABLE CUDA CUDAToolkit CURL CVS Coin3D Cups
Curses CxxTest Cygwin DCMTK Dart DevIL Doxygen EXPAT EnvModules FLEX FLTK FLTK2 Fontconfig Freetype GCCXML GDAL GIF
GLEW GLU GLUT GSL GTK GTK2 GTest Gettext Git GnuTLS Gnuplot HDF5 HSPELL HTMLHelp Hg ICU ITK Ice Iconv Icotool
ImageMagick Intl JNI JPEG Jasper Java KDE3 KDE4 LAPACK LATEX LTTngUST LibArchive LibLZMA LibXml2 LibXslt Libinput Lua
Lua50 Lua51 MFC MPEG MPEG2 MPI Matlab Motif Msys ODBC OpenACC OpenAL OpenCL OpenGL OpenMP OpenSP OpenSSL
OpenSceneGraph OpenThreads PHP4 PNG PackageHandleStandardArgs PackageMessage Patch Perl PerlLibs PhysFS Pike PkgConfig
PostgreSQL Producer Protobuf Python Python2 Python3 PythonInterp PythonLibs Qt Qt3 Qt4 QuickTime RTI Ruby SDL SDL_gfx
SDL_image SDL_mixer SDL_net SDL_sound SDL_ttf SQLite3 SWIG SelfPackers Squish Subversion TCL TIFF TclStub Tclsh
Threads UnixCommands VTK Vulkan Wget Wish X11 XCTest XMLRPC XalanC XercesC ZLIB wxWidgets wxWindows osg osgAnimation
osgDB osgFX osgGA osgIntrospection osgManipulator osgParticle osgPresentation osgProducer osgQt osgShadow osgSim
osgTerrain osgText osgUtil osgViewer osgVolume osgWidget osg_functions
"""
CMAKE_MODULES = frozenset(_CMAKE_MODULES.split())
"""Names of the find modules of CMake 3.25 and 4.4. Many of these modules find a library for which there is a rosdep key."""

_CXX_HEADERS = """
algorithm any array atomic barrier bit bitset cassert ccomplex cctype cerrno cfenv cfloat charconv chrono cinttypes
ciso646 climits clocale cmath codecvt compare complex concepts condition_variable coroutine csetjmp csignal cstdalign
cstdarg cstdbool cstddef cstdint cstdio cstdlib cstring ctgmath ctime cuchar cwchar cwctype debugging deque exception
execution expected filesystem flat_map flat_set format forward_list fstream functional future generator hazard_pointer
initializer_list inplace_vector iomanip ios iosfwd iostream istream iterator latch limits linalg list locale map
mdspan memory memory_resource mutex new numbers numeric optional ostream print queue random ranges ratio rcu regex
scoped_allocator semaphore set shared_mutex source_location span spanstream sstream stack stacktrace stdexcept
stdfloat stop_token streambuf string string_view strstream syncstream system_error text_encoding thread tuple
type_traits typeindex typeinfo unordered_map unordered_set utility valarray variant vector version assert.h complex.h
ctype.h errno.h fenv.h float.h inttypes.h iso646.h limits.h locale.h math.h setjmp.h signal.h stdalign.h stdarg.h
stdatomic.h stdbit.h stdbool.h stdckdint.h stddef.h stdint.h stdio.h stdlib.h stdnoreturn.h string.h tgmath.h
threads.h time.h uchar.h wchar.h wctype.h aio.h alloca.h argp.h byteswap.h cpio.h cxxabi.h dirent.h dlfcn.h elf.h
endian.h envz.h err.h error.h execinfo.h fcntl.h features.h fmtmsg.h fnmatch.h ftw.h getopt.h glob.h gnu-versions.h
grp.h iconv.h ifaddrs.h immintrin.h arm_neon.h emmintrin.h x86intrin.h smmintrin.h tmmintrin.h pmmintrin.h xmmintrin.h
avxintrin.h cpuid.h langinfo.h libgen.h libintl.h link.h malloc.h mcheck.h memory.h mntent.h monetary.h mqueue.h
ndbm.h netdb.h nl_types.h obstack.h paths.h poll.h printf.h pthread.h pty.h pwd.h regex.h resolv.h sched.h search.h
semaphore.h shadow.h spawn.h stab.h strings.h stropts.h syslog.h tar.h termio.h termios.h trace.h ucontext.h ulimit.h
unistd.h unwind.h utime.h utmp.h utmpx.h values.h wait.h wordexp.h windows.h Windows.h winsock2.h WinSock2.h
ws2tcpip.h io.h direct.h process.h tchar.h intrin.h conio.h psapi.h shlwapi.h
"""
CXX_HEADERS = frozenset(_CXX_HEADERS.split())
"""Headers of the C and C++ standard libraries, POSIX, glibc, compilers and Windows."""

_FOLDERS = "sys linux net netinet netpacket arpa asm asm-generic bits gnu rpc scsi experimental ext parallel tr1 mach"
SYSTEM_HEADER_FOLDERS = frozenset(_FOLDERS.split())
"""First folders in the paths of headers that a C or C++ tool chain provides, e.g. "sys" in ``sys/types.h``."""
