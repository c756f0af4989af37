// The page of whoever runs the study. All texts of others enter it as text, never as markup.
const REFRESH = 5000; // [ms]
const at = (id) => document.getElementById(id);

// The cookie is set: the token need not stay in the address and the history.
history.replaceState(null, "", location.pathname);

function row(...cells) {
  const line = document.createElement("tr");
  for (const cell of cells) {
    const field = document.createElement("td");
    field.textContent = cell ?? "";
    if (typeof cell === "number") field.className = "number";
    line.append(field);
  }
  return line;
}

function facts(pairs) {
  return pairs.flatMap(([name, value]) => {
    const [term, said] = [document.createElement("dt"), document.createElement("dd")];
    term.textContent = name;
    said.textContent = value;
    return [term, said];
  });
}

function roleRows({ roles, participants }) {
  return Object.entries(roles).map(([role, planned]) => {
    const of = participants.filter((one) => one.role === role && one.kind === "person");
    const count = (status) => of.filter((one) => one.status === status).length;
    return row(role, planned, count("invited"), count("active"), count("done"), count("stopped"));
  });
}

function status(one) {
  const words = { invited: "invited", active: "taking part", done: "done", stopped: "stopped" };
  const now = one.playing ? ", connected" : "";
  const script = one.kind === "scripted" ? " (script, no person)" : "";
  return (words[one.status] ?? one.status) + now + script;
}

function refusals(counts) {
  const all = Object.entries(counts).sort((a, b) => b[1] - a[1]);
  return all.length === 0 ? "none" : all.map(([why, count]) => `${why} ${count}`).join(", ");
}

function health({ since_start: now, refused }) {
  const pace = now.period_ms;
  return facts([
    ["Connected now", String(now.connected)],
    ["Time between steps", pace === null ? "nobody has played yet"
      : `${pace.p50} ms (median), ${pace.p95} ms (95 %), ${pace.max} ms (longest), of the last ${pace.steps} steps`],
    ["Refused messages", refusals(refused)],
  ]);
}

function show(found) {
  document.title = at("title").textContent = found.title;
  at("now").textContent = `As of ${new Date(found.now).toLocaleTimeString()}, refreshed every ${REFRESH / 1000} s`;
  at("roles").replaceChildren(...roleRows(found));
  at("people").replaceChildren(...found.participants.map((one) => row(
    one.code, one.role, one.external_id, status(one), one.episodes, one.answers,
    one.last_seen && new Date(one.last_seen).toLocaleString())));
  at("withdrawn").textContent = found.withdrawn.length === 0 ? "" : `Withdrawn and deleted: ${found.withdrawn.join(", ")}`;
  at("health").replaceChildren(...health(found));
  if (at("role").options.length === 0) {
    at("role").append(...Object.keys(found.roles).map((role) => new Option(role)));
  }
}

async function refresh() {
  try {
    const answer = await fetch("/admin/api/progress", { cache: "no-store" });
    if (answer.ok) show(await answer.json());
    else at("now").textContent = answer.status === 401 ? "Signed out: open the admin link again." : "The server is busy.";
  } catch {
    at("now").textContent = "The server cannot be reached; trying again.";
  }
  setTimeout(refresh, REFRESH);
}

async function invite(event) {
  event.preventDefault();
  const wish = { role: at("role").value, count: Number(at("count").value) };
  if (at("external").value.trim()) wish.external_id = at("external").value.trim();
  const answer = await fetch("/admin/api/invite", {
    method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(wish),
  });
  const told = await answer.json();
  at("problem").textContent = answer.ok ? "" : told.message;
  if (!answer.ok) return;
  at("links").textContent += told.links.map(({ code, link }) => `${code}  ${told.role}  ${link}\n`).join("");
  at("links").hidden = false;
  at("copy").hidden = !isSecureContext;
}

at("invite").addEventListener("submit", (event) => void invite(event));
at("copy").addEventListener("click", () => void navigator.clipboard.writeText(at("links").textContent));
void refresh();
