// A list being read or written: its page, and the number of its next entry.
struct Cursor {
    page: u32,
    entry: u32,
}

// The next sensor of a list; of all sensors if there is none.
fn next_sensor(cursor: ptr<function, Cursor>, listed: bool) -> u32 {
    let entry = (*cursor).entry;
    (*cursor).entry += 1u;
    if !listed {
        return entry;
    }
    let within = entry % PAGE;
    if within == 0u && entry > 0u {
        (*cursor).page = pages[PAGE * sight.counts.y + (*cursor).page];
    }
    return pages[PAGE * (*cursor).page + within];
}
