"use strict";
// A two-alternative study: pairs of clips in step, answers kept in this browser, saved as a file; no network.
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const words = data.words;
  const $ = (id) => document.getElementById(id);
  const say = (key, values = {}) => words[key].replace(/\{(\w+)\}/g, (_, name) => values[name]);
  for (const each of document.querySelectorAll("[data-word]")) each.textContent = say(each.dataset.word);

  // What is kept between visits.
  const place = `physanimator-study-${data.study}`;
  const fresh = () => ({ rater: random(), started: new Date().toISOString(), answers: {}, at: 0, practised: !data.practice });
  function random() {
    const bytes = crypto.getRandomValues(new Uint8Array(8));
    return [...bytes].map((each) => each.toString(16).padStart(2, "0")).join("");
  }
  function kept() {
    try {
      const found = JSON.parse(localStorage.getItem(place));
      return found && typeof found.rater === "string" && found.answers && Number.isInteger(found.at) ? found : null;
    } catch { return null; }
  }
  let memory = true;
  let state = kept() || fresh();
  const resumed = Object.keys(state.answers).length > 0;
  function keep() {
    try { localStorage.setItem(place, JSON.stringify(state)); } catch { memory = false; }
    $("no-memory").hidden = memory;
  }
  keep();

  // Clips: from the page itself as blobs, which every browser seeks in, or from files beside it.
  const addresses = new Map();
  function address(number) {
    if (data.beside) return data.clips[number];
    if (!addresses.has(number)) {
      const bytes = Uint8Array.from(atob(data.clips[number]), (each) => each.charCodeAt(0));
      addresses.set(number, URL.createObjectURL(new Blob([bytes], { type: "video/mp4" })));
    }
    return addresses.get(number);
  }
  function forget(used) {
    for (const [number, url] of addresses) if (!used.includes(number)) { URL.revokeObjectURL(url); addresses.delete(number); }
  }

  // Two videos in step: both start when both can, the earlier one waits at its end, drift is taken back.
  const videos = [$("left"), $("right")];
  let playing = false, turn = 0;
  function loaded(video) {
    return new Promise((done, failed) => {
      if (video.readyState >= 3) return done();
      video.addEventListener("canplay", done, { once: true });
      video.addEventListener("error", failed, { once: true });
    });
  }
  async function fromStart() {
    const mine = ++turn;
    for (const each of videos) { each.pause(); each.currentTime = 0; }
    try {
      await Promise.all(videos.map(loaded));
      if (mine !== turn) return;
      playing = true;
      await Promise.all(videos.map((each) => each.play()));
    } catch (error) {
      if (mine !== turn) return;
      playing = false;
      if (error.name !== "NotAllowedError" && error.name !== "AbortError") tell(say("failed"));
    }
    shown();
  }
  function toggle() {
    if (playing) { turn++; playing = false; for (const each of videos) each.pause(); shown(); }
    else if (videos.every((each) => each.ended)) fromStart();
    else { playing = true; for (const each of videos) if (!each.ended) each.play().catch(() => { playing = false; shown(); }); shown(); }
  }
  function shown() { $("play").textContent = say(playing ? "stop" : "play"); }
  for (const each of videos) {
    each.addEventListener("ended", () => { if (playing && videos.every((one) => one.ended)) fromStart(); });
    each.addEventListener("error", () => { if (each.getAttribute("src")) tell(say("failed")); });
  }
  function inStep() {
    const [a, b] = videos;
    if (playing && !a.ended && !b.ended && Math.abs(a.currentTime - b.currentTime) > 0.06) b.currentTime = a.currentTime;
    requestAnimationFrame(inStep);
  }
  requestAnimationFrame(inStep);

  // Pairs and questions.
  const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
  let trial = null, practising = false, current = 0, since = 0;
  function tell(text) { $("note").textContent = text; $("note").hidden = !text; }
  function section(name) {
    for (const each of ["intro", "pair", "end"]) $(each).hidden = each !== name;
    if (name !== "pair") { turn++; playing = false; for (const each of videos) each.pause(); }
    document.querySelector("h1").focus({ preventScroll: true });
    scrollTo(0, 0);
  }
  function open() {
    practising = !state.practised;
    if (!practising && state.at >= data.trials.length) return section("end");
    trial = practising ? data.practice : data.trials[state.at];
    section("pair");
    tell("");
    $("practice").hidden = !practising;
    $("where").textContent = practising ? "" : say("pair", { done: state.at + 1, total: data.trials.length });
    $("bar").value = practising ? 0 : state.at / data.trials.length;
    $("back").disabled = practising || state.at === 0;
    forget([trial.left, trial.right]);
    videos[0].src = address(trial.left);
    videos[1].src = address(trial.right);
    draw();
    since = performance.now();
    playing = false;
    shown();
    if (!still) fromStart();
  }
  const practised = {};
  const answers = () => (practising ? practised : (state.answers[trial.id] ||= {}));
  const questions = () => (practising ? data.questions.slice(0, 1) : data.questions);
  function draw() {
    const box = $("questions");
    box.replaceChildren(...questions().map((question, number) => {
      const field = document.createElement("fieldset");
      const legend = document.createElement("legend");
      legend.textContent = question.text;
      const choice = document.createElement("div");
      choice.className = "choice";
      choice.setAttribute("role", "radiogroup");
      choice.setAttribute("aria-label", question.text);
      for (const side of ["left", "right"]) {
        const button = document.createElement("button");
        button.type = "button";
        button.dataset.side = side;
        button.setAttribute("role", "radio");
        button.textContent = say(side);
        button.addEventListener("click", () => choose(number, side));
        button.addEventListener("focus", () => { current = number; mark(); });
        choice.append(button);
      }
      field.append(legend, choice);
      return field;
    }));
    current = Math.max(0, questions().findIndex((each) => !answers()[each.key]));
    mark();
  }
  function mark() {
    $("questions").querySelectorAll("fieldset").forEach((field, number) => {
      const answer = answers()[questions()[number].key];
      field.classList.toggle("current", number === current);
      for (const each of field.querySelectorAll("button")) {
        each.setAttribute("aria-checked", String(answer?.choice === each.dataset.side));
      }
    });
    $("next").disabled = !questions().every((each) => answers()[each.key]);
    $("next").textContent = say(!practising && state.at === data.trials.length - 1 ? "finish" : "next");
  }
  function choose(number, side) {
    if (practising) {
      const right = side === data.practice.true;
      tell(right ? "" : say("wrong"));
      if (!right) { delete practised[questions()[0].key]; return mark(); }
    }
    answers()[questions()[number].key] = { choice: side, seconds: Math.round((performance.now() - since) / 100) / 10 };
    const open = questions().findIndex((each) => !answers()[each.key]);
    current = open < 0 ? number : open;
    keep();
    mark();
  }
  function next() {
    if ($("next").disabled) return;
    if (practising) state.practised = true;
    else state.at += 1;
    keep();
    open();
  }
  function back() {
    if ($("back").disabled) return;
    state.at -= 1;
    keep();
    open();
  }
  function save() {
    const list = data.trials.flatMap((each) => Object.entries(state.answers[each.id] || {}).map(
      ([question, answer]) => ({ trial: each.id, question, choice: answer.choice, seconds: answer.seconds })));
    const file = {
      format: "physanimator study answers", version: 1, study: data.study, rater: state.rater, language: data.language,
      started: state.started, saved: new Date().toISOString(), answers: list,
    };
    const name = `answers_${data.study}_${state.rater}.json`;
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([JSON.stringify(file, null, 1)], { type: "application/json" }));
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
    $("saved").textContent = say("saved", { name });
  }

  $("start").addEventListener("click", open);
  if (resumed) { $("start").textContent = say("resume"); $("clear").hidden = false; }
  $("clear").addEventListener("click", () => {
    if (!confirm(say("sure"))) return;
    state = fresh();
    keep();
    $("clear").hidden = true;
    $("start").textContent = say("start");
  });
  $("play").addEventListener("click", toggle);
  $("again").addEventListener("click", fromStart);
  $("next").addEventListener("click", next);
  $("back").addEventListener("click", back);
  $("save").addEventListener("click", save);
  $("review").addEventListener("click", () => { state.at = 0; keep(); open(); });
  addEventListener("keydown", (event) => {
    if ($("pair").hidden || event.ctrlKey || event.metaKey || event.altKey || event.repeat) return;
    const side = { 1: "left", ArrowLeft: "left", 2: "right", ArrowRight: "right" }[event.key];
    const onButton = event.target instanceof HTMLButtonElement;
    if (side) choose(current, side);
    else if (event.key === "Enter" && !(onButton && (!event.target.dataset.side || $("next").disabled))) next();
    else if (event.key === "Backspace") back();
    else if (event.key === " " && !onButton) toggle();
    else if (event.key === "ArrowUp" || event.key === "ArrowDown") {
      current = Math.min(questions().length - 1, Math.max(0, current + (event.key === "ArrowUp" ? -1 : 1)));
      mark();
    } else return;
    event.preventDefault();
  });
})();
