/* dump.c - see dump.h.  SPDX-License-Identifier: GPL-3.0-or-later */
#include "measure/dump.h"

#include "measure/npy.h"

#include <stdlib.h>
#include <string.h>

/* The records of a file, one field after the other without gaps. */
enum {
    RECORD_BYTES = 0
#define X(name, type, word) + sizeof(type)
    DUMP_FIELDS(X)
#undef X
};

static const char grains_type[] = "["
#define X(name, type, word) "('" #name "', '" word "'), "
    DUMP_FIELDS(X)
#undef X
    "]";

static const char contacts_type[] = "[('i', '<u4'), ('j', '<u4'), ('x', '<f4'), ('y', '<f4'), "
                                    "('fx', '<f4'), ('fy', '<f4'), ('overlap', '<f4')]";
_Static_assert(sizeof(struct contact) == 28, "contacts are written as they lie in memory");

bool dump_save(const char *path, const struct grains *grains, struct error *error)
{
    const uint64_t count = grains->count;
    unsigned char *records = calloc(count + 1, RECORD_BYTES);
    if (!records) return error_set(error, "%s: not enough memory to write %u grains", path,
                                   grains->count);
    size_t offset = 0;
#define X(name, type, word)                                                                     \
    for (size_t k = 0; grains->name && k < count; k++) {                                        \
        memcpy(records + k * RECORD_BYTES + offset, &grains->name[k], sizeof(type));            \
    }                                                                                           \
    offset += sizeof(type);
    DUMP_FIELDS(X)
#undef X
    const bool done = npy_save(path, grains_type, &count, 1, records, error);
    free(records);
    return done;
}

bool dump_save_contacts(const char *path, const struct grains *grains, struct error *error)
{
    const uint64_t count = grains->contacts ? grains->contact_count : 0;
    return npy_save(path, contacts_type, &count, 1, grains->contacts, error);
}

/* A one-dimensional file of exactly this type. */
static bool load_list(const char *path, const char *type, const char *what, struct npy *npy,
                      struct error *error)
{
    if (!npy_load(path, npy, error)) return false;
    const bool fits = npy_is(npy, type) && npy->dimensions == 1 && npy->count < CONTACT_WALL;
    if (fits) return true;
    npy_free(npy);
    return error_set(error, "%s: not a dump of %s: one list of the type %s is needed", path, what,
                     type);
}

static void take_grains(struct grains *grains, const struct npy *npy)
{
    const unsigned char *records = npy->values;
    size_t offset = 0;
    grains->count = (uint32_t)npy->count;
#define X(name, type, word)                                                                     \
    for (size_t k = 0; k < npy->count; k++) {                                                   \
        memcpy(&grains->name[k], records + k * RECORD_BYTES + offset, sizeof(type));            \
    }                                                                                           \
    offset += sizeof(type);
    DUMP_FIELDS(X)
#undef X
}

/* Contacts name grains by their place in the list: a foreign file must not lead outside of it. */
static bool take_contacts(struct grains *grains, const struct npy *npy, const char *path,
                          struct error *error)
{
    grains->contact_count = (uint32_t)npy->count;
    if (npy->count > 0) memcpy(grains->contacts, npy->values, npy->count * npy->width);
    for (uint32_t k = 0; k < grains->contact_count; k++) {
        const struct contact *c = &grains->contacts[k];
        if (c->i < grains->count && (c->j < grains->count || c->j >= CONTACT_WALL)) continue;
        return error_set(error, "%s: contact %u names grains %u and %u of %u; the file belongs to "
                         "another frame", path, k, c->i, c->j, grains->count);
    }
    return true;
}

bool dump_load(const char *path, const char *contacts_path, struct grains *grains,
               struct error *error)
{
    struct npy list = {0}, contacts = {0};
    *grains = (struct grains){0};
    bool done = load_list(path, grains_type, "grains", &list, error);
    done = done && (!contacts_path
                    || load_list(contacts_path, contacts_type, "contacts", &contacts, error));
    /* One more than needed, so that an empty frame has arrays too. */
    done = done && grains_create(grains, (uint32_t)list.count + 1,
                                 contacts_path ? (uint32_t)contacts.count + 1 : 0, error);
    if (done) take_grains(grains, &list);
    done = done && (!contacts_path || take_contacts(grains, &contacts, contacts_path, error));
    if (!done) grains_free(grains);
    npy_free(&list);
    npy_free(&contacts);
    return done;
}
