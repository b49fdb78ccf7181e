# A voxrt blob, version 1; blob.md says what the fields mean.
meta:
  id: voxrt_blob
  file-extension: blob
  endian: le
  encoding: UTF-8
seq:
  - id: magic
    contents: VOXRTBLB
  - id: version
    type: u4
  - id: num_sections
    type: u4
  - id: len_file
    type: u4
  - id: table_crc32
    type: u4
  - id: sections
    type: section
    repeat: expr
    repeat-expr: num_sections
types:
  section:
    seq:
      - id: name
        type: str
        size: 4
      - id: ofs_body
        type: u4
      - id: len_body
        type: u4
      - id: crc32
        type: u4
    instances:
      body:
        pos: ofs_body
        size: len_body
        type:
          switch-on: name
          cases:
            '"NAME"': title
            '"WRLD"': world
            '"MATL"': materials
            '"WORD"': words
            '"VIEW"': view
            '"LITE"': lighting
            '"FACE"': faces
            '"FRMS"': frames
  title:
    seq:
      - id: text
        type: str
        size-eos: true
  world:
    seq:
      - id: depth
        type: u4
      - id: known
        type: u4
      - id: origin
        type: f8
        repeat: expr
        repeat-expr: 3
      - id: voxel_size
        type: f8
  materials:
    seq:
      - id: num_entries
        type: u4
      - id: entries
        type: material
        repeat: expr
        repeat-expr: num_entries
  material:
    seq:
      - id: red
        type: u1
      - id: green
        type: u1
      - id: blue
        type: u1
      - id: flags
        type: u1
      - id: len_name
        type: u2
      - id: zero
        type: u2
      - id: name
        type: str
        size: len_name
      - id: padding
        size: (8 - len_name % 8) % 8
  words:
    seq:
      - id: words
        type: u4
        repeat: eos
  view:
    seq:
      - id: position
        type: s4
        repeat: expr
        repeat-expr: 3
      - id: look
        type: s4
        repeat: expr
        repeat-expr: 3
      - id: right
        type: s4
        repeat: expr
        repeat-expr: 3
      - id: up
        type: s4
        repeat: expr
        repeat-expr: 3
  lighting:
    seq:
      - id: position
        type: s4
        repeat: expr
        repeat-expr: 3
      - id: ambient
        type: u1
      - id: flags
        type: u1
      - id: bounces
        type: u1
      - id: zero
        type: u1
  faces:
    seq:
      - id: brightness
        type: u1
        repeat: expr
        repeat-expr: 6
  frames:
    seq:
      - id: num_entries
        type: u4
      - id: zero
        type: u4
      - id: entries
        type: frame
        repeat: expr
        repeat-expr: num_entries
  frame:
    seq:
      - id: root
        type: u4
      - id: words
        type: u4
      - id: second
        type: f8
      - id: len_name
        type: u2
      - id: zero
        size: 6
      - id: name
        type: str
        size: len_name
      - id: padding
        size: (8 - len_name % 8) % 8
