// The search of the documentation. It uses lunr, which the first use of the field loads together with the index. The
// index is a script instead of JSON, so that the search works without a server.
(() => {
  "use strict";
  const base = document.currentScript.dataset.base;
  const field = document.getElementById("search");
  const list = document.getElementById("results");
  const kMaxResults = 12, kExcerpt = 160;
  // pages that name everything, but that few readers look for
  const kMinor = /^(project\/|howto\/from-)/, kMinorBoost = 0.3;
  let index = null, loading = null;

  field.parentElement.hidden = false;

  // the list of pages may be longer than the window
  const current = document.querySelector("nav [aria-current]");
  if (current) current.closest("nav").scrollTop = current.offsetTop - window.innerHeight / 2;

  function load(file) {
    return new Promise((done, failed) => {
      const script = document.createElement("script");
      script.src = `${base}/search/${file}`;
      script.onload = done;
      script.onerror = () => failed(new Error(`${file} is missing`));
      document.head.append(script);
    });
  }

  // Names such as /physics/sim/gravity, sim:load_urdf and angular_servo_position consist of several words.
  const words = (text) => text.toLowerCase().split(/[^\p{L}\p{N}]+/u).filter((word) => word !== "");

  function build() {
    lunr.tokenizer.separator = /[^\p{L}\p{N}]+/u;
    return lunr(function () {
      this.ref("id");
      this.field("title", { boost: 8 });
      this.field("page", { boost: 3 });
      this.field("text");
      limberPages.forEach((entry, id) => {
        this.add({ id, ...entry }, { boost: kMinor.test(entry.location) ? kMinorBoost : 1 });
      });
    });
  }

  function prepare() {
    loading ??= Promise.all([load("lunr.js"), load("search_index.js")]).then(() => { index = build(); });
    return loading;
  }

  // Returns the words of a query, without "the", "how" and so on unless there are no others.
  function search_terms(text) {
    const all = words(text);
    const terms = all.filter((word) => lunr.stopWordFilter(new lunr.Token(word)) !== undefined);
    return terms.length > 0 ? terms : all;
  }

  // Finds sections with all terms or words that begin with them, then sections with some of the terms.
  function find(terms) {
    if (terms.length === 0) return [];
    const query = (presence) => index.query((q) => {
      for (const word of terms) {
        const stem = lunr.stemmer(new lunr.Token(word)).toString();
        q.term(stem, { usePipeline: false, wildcard: lunr.Query.wildcard.TRAILING, presence });
        q.term(stem, { usePipeline: false, boost: 5 });
      }
    });
    const found = query(lunr.Query.presence.REQUIRED);
    if (found.length < kMaxResults) {
      const known = new Set(found.map((result) => result.ref));
      found.push(...query(lunr.Query.presence.OPTIONAL).filter((result) => !known.has(result.ref)));
    }
    return found.slice(0, kMaxResults).map((result) => limberPages[result.ref]);
  }

  // Adds the text to an element, with the words that begin with a search term marked.
  function add_marked(element, text, terms) {
    const parts = text.split(/([^\p{L}\p{N}]+)/u);
    for (const part of parts) {
      if (terms.some((term) => part.toLowerCase().startsWith(term))) {
        element.append(Object.assign(document.createElement("mark"), { textContent: part }));
      } else {
        element.append(part);
      }
    }
  }

  function excerpt(text, terms) {
    const lower = text.toLowerCase();
    const places = terms.map((term) => lower.indexOf(term)).filter((at) => at >= 0);
    const first = places.length > 0 ? Math.min(...places) : 0;
    const begin = first < 60 ? 0 : text.indexOf(" ", first - 60) + 1;
    const part = text.slice(begin, begin + kExcerpt);
    return (begin > 0 ? "… " : "") + part + (begin + kExcerpt < text.length ? " …" : "");
  }

  function result_link(entry, terms, id) {
    const link = document.createElement("a");
    link.href = `${base}/${entry.location}`;
    link.id = `result${id}`;
    link.setAttribute("role", "option");
    link.tabIndex = -1;
    const title = document.createElement("b");
    title.textContent = entry.title === entry.page ? entry.title : `${entry.page}: ${entry.title}`;
    const text = document.createElement("small");
    add_marked(text, excerpt(entry.text, terms), terms);
    link.append(title, text);
    return link;
  }

  function select(link) {
    for (const other of list.querySelectorAll("a")) other.setAttribute("aria-selected", other === link);
    if (link) {
      field.setAttribute("aria-activedescendant", link.id);
      link.scrollIntoView({ block: "nearest" });
    } else {
      field.removeAttribute("aria-activedescendant");
    }
  }

  function open(is_open) {
    list.hidden = !is_open;
    field.setAttribute("aria-expanded", is_open);
  }

  function show_note(text) {
    list.replaceChildren(Object.assign(document.createElement("p"), { textContent: text }));
  }

  async function update() {
    const text = field.value;
    select(null);
    open(text.trim() !== "");
    if (list.hidden) return;
    if (index === null) show_note("Loading the index …");
    try {
      await prepare();
    } catch (error) {
      show_note(`The search is not available: ${error.message}.`);
      return;
    }
    if (field.value !== text) return;  // a later call shows the results
    const terms = search_terms(text);
    const links = find(terms).map((entry, id) => result_link(entry, terms, id));
    if (links.length === 0) show_note("Nothing found. Try fewer or shorter words.");
    else list.replaceChildren(...links);
    select(list.querySelector("a"));
  }

  function move(by) {
    const links = [...list.querySelectorAll("a")];
    if (links.length === 0) return;
    const at = links.findIndex((link) => link.getAttribute("aria-selected") === "true");
    select(links[(at + by + links.length) % links.length]);
  }

  field.addEventListener("focus", () => { prepare().catch(() => {}); if (field.value !== "") update(); });
  field.addEventListener("input", update);
  field.addEventListener("keydown", (event) => {
    if (event.key === "ArrowDown") move(1);
    else if (event.key === "ArrowUp") move(-1);
    else if (event.key === "Enter") list.querySelector('[aria-selected="true"]')?.click();
    else if (event.key === "Escape") { open(false); field.blur(); }
    else return;
    event.preventDefault();
  });
  document.addEventListener("keydown", (event) => {
    if (event.key !== "/" || event.ctrlKey || event.metaKey || event.altKey || event.target === field) return;
    event.preventDefault();
    field.focus();
    field.select();
  });
  document.addEventListener("click", (event) => {
    if (!field.parentElement.contains(event.target) || event.target.closest("#results a")) open(false);
  });
})();
