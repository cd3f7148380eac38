#include "text/locale.h"

#include <fenv.h>

locale_t ethd__c_locale;

__attribute__((constructor)) static void make_c_locale(void) {
  ethd__c_locale = newlocale(LC_ALL_MASK, "C", (locale_t)0);
}

/* What a thread has of its own while it works on text. */
typedef struct own {
  locale_t locale;
  int strange; /* another rounding than to nearest, or traps */
  fenv_t environment;
} own;

static void set_aside(own *o) {
  o->locale = uselocale(ethd__c_locale);
  o->strange = fegetround() != FE_TONEAREST || fegetexcept() != 0;
  if (!o->strange) return;
  fegetenv(&o->environment);
  fesetenv(FE_DFL_ENV);
}

static void give_back(const own *o) {
  uselocale(o->locale);
  if (o->strange) fesetenv(&o->environment);
}

/* A name in parentheses is the C library's own. */
#define IN_C(type, call)  \
  own o;                  \
  set_aside(&o);          \
  const type said = call; \
  give_back(&o);          \
  return said

double ethd__strtod(const char *text, char **end) { IN_C(double, (strtod)(text, end)); }

int ethd__glob(const char *pattern, int flags, int (*failed)(const char *path, int reason), glob_t *out) {
  IN_C(int, (glob)(pattern, flags, failed, out));
}
int ethd__fnmatch(const char *pattern, const char *name, int flags) { IN_C(int, (fnmatch)(pattern, name, flags)); }

int ethd__alphasort(const struct dirent **a, const struct dirent **b) { return strcmp((*a)->d_name, (*b)->d_name); }

static int vsscanf_in_c(const char *text, const char *format, va_list args) { IN_C(int, vsscanf(text, format, args)); }
static int vfprintf_in_c(FILE *file, const char *format, va_list args) { IN_C(int, (vfprintf)(file, format, args)); }
int ethd__vsnprintf(char *out, size_t room, const char *format, va_list args) {
  IN_C(int, (vsnprintf)(out, room, format, args));
}
int ethd__vasprintf(char **out, const char *format, va_list args) { IN_C(int, (vasprintf)(out, format, args)); }

int ethd__vprintf(const char *format, va_list args) { return vfprintf_in_c(stdout, format, args); }

#define WITH_ARGS(call)   \
  va_list args;           \
  va_start(args, format); \
  const int said = call;  \
  va_end(args);           \
  return said

int ethd__sscanf(const char *text, const char *format, ...) { WITH_ARGS(vsscanf_in_c(text, format, args)); }
int ethd__printf(const char *format, ...) { WITH_ARGS(vfprintf_in_c(stdout, format, args)); }
int ethd__fprintf(FILE *file, const char *format, ...) { WITH_ARGS(vfprintf_in_c(file, format, args)); }
int ethd__snprintf(char *out, size_t room, const char *format, ...) {
  WITH_ARGS(ethd__vsnprintf(out, room, format, args));
}
int ethd__asprintf(char **out, const char *format, ...) { WITH_ARGS(ethd__vasprintf(out, format, args)); }
