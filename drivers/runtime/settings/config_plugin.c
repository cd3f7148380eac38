#include <dlfcn.h>
#include <elf.h>
#include <errno.h>
#include <link.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "ethd/plugin.h"
#include "settings/config_parts.h"
#include "settings/plugin_fault.h"
#include "text/error_text.h"
#include "text/text.h"

/* ---- the file: the loader maps it as it is, and a missing page would end the process ---- */

static bool read_at(FILE *file, uint64_t offset, void *out, size_t length) {
  return fseeko(file, (off_t)offset, SEEK_SET) == 0 && fread(out, 1, length, file) == length;
}

static bool own_header(ElfW(Ehdr) * out) {
  FILE *file = fopen("/proc/self/exe", "rbe");
  bool read = file && read_at(file, 0, out, sizeof *out);
  if (file) fclose(file);
  return read;
}

static bool for_this_machine(const ElfW(Ehdr) * h) {
  ElfW(Ehdr) own;
  if (!own_header(&own)) return true; /* then the loader decides */
  return h->e_ident[EI_CLASS] == own.e_ident[EI_CLASS] && h->e_ident[EI_DATA] == own.e_ident[EI_DATA] &&
         h->e_machine == own.e_machine;
}

static const char *segments_fault(FILE *file, const ElfW(Ehdr) * h, uint64_t size) {
  bool dynamic = false;
  if (h->e_phentsize != sizeof(ElfW(Phdr)) || !h->e_phnum) return "has no segments";
  if (h->e_phoff > size || (uint64_t)h->e_phnum * sizeof(ElfW(Phdr)) > size - h->e_phoff) return "is cut short";
  for (unsigned i = 0; i < h->e_phnum; i++) {
    ElfW(Phdr) p;
    if (!read_at(file, h->e_phoff + i * sizeof p, &p, sizeof p)) return "is cut short";
    if (p.p_offset > size || p.p_filesz > size - p.p_offset) return "is cut short";
    dynamic |= p.p_type == PT_DYNAMIC && p.p_filesz >= sizeof(ElfW(Dyn));
  }
  return dynamic ? NULL : "isn't a shared object";
}

/* Returns what is wrong with the file. A linker writes the section headers last, so a file without them was cut
   short. */
static const char *file_fault(FILE *file, uint64_t size) {
  ElfW(Ehdr) h;
  if (size == 0) return "is empty";
  if (!read_at(file, 0, &h, sizeof h))
    return size < sizeof h ? "is cut short or isn't a shared object" : "can't be read";
  if (memcmp(h.e_ident, ELFMAG, SELFMAG) != 0) return "isn't a shared object";
  if (!for_this_machine(&h)) return "was built for another machine";
  if (h.e_type != ET_DYN) return "isn't a shared object";
  if (h.e_shoff && (h.e_shoff > size || (uint64_t)h.e_shnum * h.e_shentsize > size - h.e_shoff)) return "is cut short";
  return segments_fault(file, &h, size);
}

ethd_status ethd__plugin_file_check(const char *path, char what[ETHD_MESSAGE_MAX]) {
  struct stat info;
  if (stat(path, &info) != 0) return ethd__say(what, ETHD_E_FILE, "%s: %s", path, strerror(errno));
  if (!S_ISREG(info.st_mode)) return ethd__say(what, ETHD_E_LOAD, "%s is no file", path);
  FILE *file = fopen(path, "rbe");
  if (!file) return ethd__say(what, ETHD_E_FILE, "%s: %s", path, strerror(errno));
  const char *fault = file_fault(file, (uint64_t)info.st_size);
  fclose(file);
  return fault ? ethd__say(what, ETHD_E_LOAD, "%s %s", path, fault) : ETHD_OK;
}

static ethd_status no_memory(const ethd__key *key) {
  return ethd__key_refuse(key, ETHD_E_MEMORY, "%s", ethd_status_sentence(ETHD_E_MEMORY));
}

/* ---- its laws ---- */

static uint32_t count_laws(const ethd_law *const *laws) {
  uint32_t n = 0;
  while (laws[n]) n++;
  return n;
}

static ethd_status add_laws(ethd_config *config, const ethd_plugin_entry *entry, const ethd__key *key) {
  uint32_t n = count_laws(config->laws);
  const ethd_law **laws = realloc(config->laws, (n + entry->law_count + 1) * sizeof *laws);
  if (!laws) return no_memory(key);
  config->laws = laws;
  for (uint32_t i = 0; i < entry->law_count; i++) {
    const ethd_law *law = entry->laws[i];
    for (uint32_t k = 0; k < n; k++)
      if (laws[k]->kind == law->kind && strcmp(laws[k]->id, law->id) == 0)
        return ethd__key_refuse(key, ETHD_E_DUPLICATE, "the law %s of %s is there already", law->id, entry->id);
    laws[n++] = law;
    laws[n] = NULL;
  }
  return ETHD_OK;
}

static ethd_status add_file(ethd_config *config, char *path, const ethd__key *key) {
  char **plugins = realloc(config->plugins, (config->plugin_count + 1) * sizeof *plugins);
  if (!plugins) {
    free(path);
    return no_memory(key);
  }
  config->plugins = plugins;
  plugins[config->plugin_count++] = path;
  return ETHD_OK;
}

void (*ethd__foreign_code)(const char *what, unsigned patience);

void ethd__config_foreign(const ethd_config *config, const char *what) {
  if (config->plugin_count && ethd__foreign_code) ethd__foreign_code(what, ETHD__PATIENCE);
}

static void foreign(const char *what) {
  if (ethd__foreign_code) ethd__foreign_code(what, ETHD__PATIENCE);
}

ethd_status ethd__config_check(const ethd_config *config, const ethd__config_front *front, void *setup,
                               ethd_error *error) {
  if (config->plugin_count) foreign("the check of a plugin's law");
  ethd_status status = front->check(config, setup, error);
  foreign(NULL);
  return status;
}

static ethd_status open_plugin(ethd_config *config, const char *path, const ethd__key *key) {
  char what[ETHD_MESSAGE_MAX];
  const ethd_plugin_entry *entry;
  ethd_error error;
  ethd_status status = ethd__plugin_file_check(path, what);
  if (status) return ethd__key_refuse(key, status, "%s", what);
  foreign(path);
  void *handle = dlopen(path, RTLD_NOW | RTLD_LOCAL); /* stays open, to examine a refused one */
  const char *why = handle ? NULL : dlerror();
  status = handle ? ethd_plugin_open(path, &entry, &error)
                  : ethd__say(what, ETHD_E_LOAD, "%s", why ? why : ethd_status_sentence(ETHD_E_LOAD));
  if (handle && status) ethd__plugin_fault(handle, &error, what);
  if (handle) dlclose(handle); /* ethd_plugin_open keeps an accepted one open */
  foreign(NULL);
  if (!status) return add_laws(config, entry, key);
  return handle ? ethd__key_refuse(key, status, "%s: %s", key->value, what) : ethd__key_refuse(key, status, "%s", what);
}

ethd_status ethd__config_plugin(ethd__config *whole, const ethd__key *key) {
  if (whole->received)
    return ethd__key_refuse(key, ETHD_E_LOAD, "%s is a program from outside of this folder; --plugins lets it run",
                            key->value);
  ETHD__FREED char *joined = ethd__path_join(whole->config.folder, key->value);
  char *path = joined ? realpath(joined, NULL) : NULL;
  ethd_status status;
  if (!joined)
    status = no_memory(key);
  else if (!path)
    status = ethd__key_refuse(key, ETHD_E_FILE, "%s: %s", joined, strerror(errno));
  else
    status = open_plugin(&whole->config, path, key);
  if (status) free(path);
  return status ? status : add_file(&whole->config, path, key);
}
