/* A voxrt blob, version 1, for C99 on a little-endian machine; blob.md says what the fields mean.
 *
 * Map or read the whole file into memory aligned to 8 bytes, check the header, then ask for sections by name:
 *
 *     const struct voxrt_header *blob = data;
 *     if (size < sizeof *blob || memcmp(blob->magic, VOXRT_MAGIC, 8) || blob->version != VOXRT_VERSION
 *         || blob->bytes != size) refuse();
 *     const struct voxrt_section *word = voxrt_find(blob, "WORD");
 *
 * and compare each section's CRC-32 (zlib's crc32) before use. */
#ifndef VOXRT_BLOB_H
#define VOXRT_BLOB_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#define VOXRT_MAGIC "VOXRTBLB"
#define VOXRT_VERSION 1u

struct voxrt_header {
    char magic[8];
    uint32_t version;
    uint32_t sections; /* entries of the table, which follows */
    uint32_t bytes;    /* of the whole file */
    uint32_t table_crc32;
};

struct voxrt_section {
    char name[4];
    uint32_t offset; /* from the first byte of the file */
    uint32_t bytes;  /* padding not counted */
    uint32_t crc32;
};

struct voxrt_world { /* WRLD */
    uint32_t depth;
    uint32_t known; /* whether the rest is */
    double origin[3];
    double voxel_size;
};

#define VOXRT_MIRROR 1u
#define VOXRT_AUTHORED 2u

struct voxrt_material { /* MATL: a uint32_t, then so many of these */
    uint8_t red, green, blue;
    uint8_t flags;
    uint16_t name_bytes;
    uint8_t zero[2];
    /* the name follows, then zeros to a multiple of 8 bytes */
};

struct voxrt_view { /* VIEW */
    int32_t position[3], look[3], right[3], up[3];
};

#define VOXRT_LIGHT_ON 1u
#define VOXRT_FLAT 2u

struct voxrt_lighting { /* LITE */
    int32_t position[3];
    uint8_t ambient, flags, bounces, zero;
};

struct voxrt_faces { /* FACE */
    uint8_t brightness[6]; /* of the faces that look along -x, +x, -y, +y, -z, +z */
};

struct voxrt_frame { /* FRMS: a uint32_t with their number and one that is 0, then these, each with its name behind it */
    uint32_t root, words;
    double second; /* NaN where it is not known */
    uint16_t name_bytes;
    uint8_t zero[6];
};

/* The section called `name` (4 characters), or NULL; the table must lie within the file. */
static inline const struct voxrt_section *voxrt_find(const struct voxrt_header *blob, const char *name) {
    const struct voxrt_section *section = (const struct voxrt_section *)(blob + 1);
    for (uint32_t i = 0; i < blob->sections; ++i)
        if (memcmp(section[i].name, name, 4) == 0)
            return &section[i];
    return NULL;
}

/* The material behind `material` in MATL. */
static inline const struct voxrt_material *voxrt_next_material(const struct voxrt_material *material) {
    const size_t name = (material->name_bytes + 7u) & ~(size_t)7u;
    return (const struct voxrt_material *)((const char *)(material + 1) + name);
}

#endif
