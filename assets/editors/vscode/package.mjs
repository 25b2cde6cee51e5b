// Packs the extension with its dependencies into specula.vsix: `npm ci && npm run package`. A .vsix is a ZIP archive with a manifest.
import { readFileSync, readdirSync, writeFileSync, existsSync } from 'node:fs';
import { join, dirname } from 'node:path';
import { fileURLToPath } from 'node:url';
import { deflateRawSync } from 'node:zlib';

const root = dirname(fileURLToPath(import.meta.url));
const own = ['package.json', 'extension.js', 'language-configuration.json', 'glsl.tmLanguage.json', 'README.md'];

// The files of a folder, with their paths from the root.
function files(folder) {
    return readdirSync(join(root, folder), { withFileTypes: true }).flatMap((entry) => {
        const path = `${folder}/${entry.name}`;
        if (entry.isDirectory()) return entry.name === '.bin' ? [] : files(path);
        return /\.(js|json|cjs|mjs)$|^LICENSE/i.test(entry.name) ? [path] : [];
    });
}

function crc(bytes) {
    let value = ~0;
    for (const byte of bytes) {
        value ^= byte;
        for (let bit = 0; bit < 8; bit++) value = (value >>> 1) ^ (value & 1 ? 0xedb88320 : 0);
    }
    return ~value >>> 0;
}

// A ZIP archive of [name, bytes] pairs. All times are the first that ZIP knows, so the same files give the same archive.
function zip(entries) {
    const parts = [];
    const directory = [];
    let offset = 0;
    for (const [name, bytes] of entries) {
        const path = Buffer.from(name, 'utf8');
        const packed = deflateRawSync(bytes);
        const head = Buffer.alloc(26);
        head.writeUInt16LE(20, 0);
        head.writeUInt16LE(0x0800, 2); // names are UTF-8
        head.writeUInt16LE(8, 4);
        head.writeUInt16LE(0x21, 8); // January 1, 1980
        head.writeUInt32LE(crc(bytes), 10);
        head.writeUInt32LE(packed.length, 14);
        head.writeUInt32LE(bytes.length, 18);
        head.writeUInt16LE(path.length, 22);
        const local = Buffer.concat([Buffer.from('PK\x03\x04'), head, path, packed]);
        const rest = Buffer.alloc(14);
        rest.writeUInt32LE(offset, 10);
        directory.push(Buffer.concat([Buffer.from('PK\x01\x02'), Buffer.from([20, 0]), head, rest, path]));
        parts.push(local);
        offset += local.length;
    }
    const list = Buffer.concat(directory);
    const end = Buffer.alloc(22);
    end.write('PK\x05\x06', 0, 'latin1');
    end.writeUInt16LE(entries.length, 8);
    end.writeUInt16LE(entries.length, 10);
    end.writeUInt32LE(list.length, 12);
    end.writeUInt32LE(offset, 16);
    return Buffer.concat([...parts, list, end]);
}

const about = JSON.parse(readFileSync(join(root, 'package.json'), 'utf8'));
if (!existsSync(join(root, 'node_modules/vscode-languageclient'))) {
    console.error('vscode-languageclient is missing: run `npm ci` first');
    process.exit(1);
}
const types = `<?xml version="1.0" encoding="utf-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">
<Default Extension=".json" ContentType="application/json"/><Default Extension=".js" ContentType="application/javascript"/>
<Default Extension=".cjs" ContentType="application/javascript"/><Default Extension=".mjs" ContentType="application/javascript"/>
<Default Extension=".md" ContentType="text/markdown"/><Default Extension=".txt" ContentType="text/plain"/>
<Default Extension=".vsixmanifest" ContentType="text/xml"/>
</Types>
`;
const manifest = `<?xml version="1.0" encoding="utf-8"?>
<PackageManifest Version="2.0.0" xmlns="http://schemas.microsoft.com/developer/vsx-schema/2011">
<Metadata>
<Identity Language="en-US" Id="${about.name}" Version="${about.version}" Publisher="${about.publisher}"/>
<DisplayName>${about.displayName}</DisplayName>
<Description xml:space="preserve">${about.description}</Description>
<Categories>${about.categories.join(',')}</Categories>
<Properties><Property Id="Microsoft.VisualStudio.Code.Engine" Value="${about.engines.vscode}"/></Properties>
</Metadata>
<Installation><InstallationTarget Id="Microsoft.VisualStudio.Code"/></Installation>
<Dependencies/>
<Assets><Asset Type="Microsoft.VisualStudio.Code.Manifest" Path="extension/package.json" Addressable="true"/></Assets>
</PackageManifest>
`;
const packed = [...own.filter((name) => existsSync(join(root, name))), ...files('node_modules')].sort();
const entries = [
    ['[Content_Types].xml', Buffer.from(types)],
    ['extension.vsixmanifest', Buffer.from(manifest)],
    ...packed.map((path) => [`extension/${path}`, readFileSync(join(root, path))]),
];
writeFileSync(join(root, 'specula.vsix'), zip(entries));
console.log(`specula.vsix: ${entries.length} files`);
